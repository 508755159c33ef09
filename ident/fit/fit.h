// ident: a whole fit: prepared, solved, judged.
#pragma once

#include <optional>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/loading/pendulum_recording.h"
#include "ident/fit/prepare_fit.h"
#include "ident/model/fitted_model.h"
#include "ident/model/identified_model.h"
#include "ident/observed/learn_forecasts.h"
#include "ident/parameters/fit_options.h"
#include "ident/problem/fit_point.h"
#include "ident/solver/solution.h"

namespace pushid {

class FitProblem;

// Fits and judges prepared options. A fit without a usable optimum is not ok(), and its message
// says why.
FitResult Fit(const std::vector<PendulumRecording>& recordings, const FitOptions& options,
              const SolveProgress& progress = nullptr);

// Fit, and where standing still predicts half of the recordings or more better, also with `others`
// (FitSetup::OtherStances, not prepared yet): the result that explains most, whose first warning
// says so.
FitResult FitAnyStance(const std::vector<PendulumRecording>& recordings, const FitOptions& options,
                       const std::vector<FitOptions>& others,
                       const SolveProgress& progress = nullptr);

// Solves without judging: for folds, whose models only predict. It prepares the options
// itself. forecasts: whether the model is to predict from first frames, which it learns from folds
// of its own. Errors: those of PrepareFit; no usable optimum.
Result<IdentifiedModel> SolveModel(const std::vector<PendulumRecording>& recordings,
                                   FitOptions options, bool forecasts = false);

// SolveModel, and beside it a model without each of some folds: refitted, which takes a fraction of
// a solve, or, of fits that are too large to repeat and of networks, which would remember what is
// held out, solved anew. None of a fold without a usable optimum.
struct FoldedModels {
  IdentifiedModel whole;
  std::vector<std::optional<IdentifiedModel>> without;
};
Result<FoldedModels> SolveFolds(const std::vector<PendulumRecording>& recordings,
                                FitOptions options, const std::vector<std::vector<int>>& held_out,
                                bool forecasts = false);

// Refitted without one fold after the other: people where some were recorded more than once and no
// two share a recording, otherwise (and of fewer than three people) recordings, dealt out to four
// folds. None of fewer than three recordings, and of fits that are too large to repeat:
// large networks, bodies. Folds without a usable optimum are left out.
std::vector<FoldModel> CrossFit(const FitProblem& problem, const FitPoint& optimum,
                                const IdentifiedModel& model, int num_threads);

// What forecasts from first frames are put together by, learned on recordings left out in turn;
// none where no recording stays in the model's domain. recordings: the problem's, in the axes of
// their files.
std::optional<ForecastRule> CrossFitForecasts(const FitProblem& problem, const FitPoint& optimum,
                                              const IdentifiedModel& model,
                                              const std::vector<PendulumRecording>& recordings,
                                              int num_threads);

}  // namespace pushid
