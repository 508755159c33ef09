// ident: a fitted model again, without a fold of its recordings, and what its forecasts then teach
// (observed/learn_forecasts.h).
#pragma once

#include <optional>
#include <vector>

#include "ident/observed/learn_forecasts.h"
#include "ident/problem/fit_problem.h"

namespace pushid {

// Solved again from the optimum, without one fold after the other: people where some were recorded
// more than once and no two share a recording, otherwise (and of fewer than three people)
// recordings, dealt out to four folds. Weights of residuals and spreads of pooled units are those
// of the whole fit. None of fewer than three recordings, and of fits that are too large to repeat:
// large networks, bodies. Folds without a usable optimum are left out.
std::vector<FoldModel> CrossFit(const FitProblem& problem, const FitPoint& optimum,
                                const IdentifiedModel& model, int num_threads);

// What forecasts from first frames are put together by, learned on recordings left out in turn. Of
// a model with a recording effect; none where no recording stays in its domain. recordings: the
// problem's, in the axes of their files.
std::optional<ForecastStack> CrossFitForecasts(const FitProblem& problem, const FitPoint& optimum,
                                               const IdentifiedModel& model,
                                               const std::vector<PendulumRecording>& recordings,
                                               int num_threads);

}  // namespace pushid
