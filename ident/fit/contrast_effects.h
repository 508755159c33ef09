// ident: differences in standard deviations between people.
#pragma once

#include <vector>

#include "datasets/loading/pendulum_recording.h"
#include "ident/model/fitted_model.h"

namespace pushid {

// Where the fit does not let people differ, a second one does: each parameter that is compared
// deviates by person, and its spread is estimated (problem/pooling_spread.h), while the contrast
// takes away what the label explains. Differences, intervals and p values remain those of the fit
// itself. An effect stays untold where no spread is found, of what two people share, where fewer
// than kFewestPeople people were recorded or nobody more than once, and where that fit fails.
void AddContrastEffects(const std::vector<PendulumRecording>& recordings, FitResult* result);

}  // namespace pushid
