// ident: the numbers of the filter of unknown forces: those that forecast best.
#pragma once

#include <vector>

#include "ident/observed/learn_forecasts.h"

namespace pushid {

// Of each fold by how the other folds are forecast, each by the model fitted without it; last, by
// all of them.
std::vector<ForecastStack> ChooseInputs(const std::vector<PendulumRecording>& recordings,
                                        const std::vector<FoldModel>& folds, int num_threads);

}  // namespace pushid
