// ident: a whole fit: solved by data that weigh as much as they know, with the demand to settle
// tested, and judged.
//
// 1. The fit is solved without the demand. Sigmas and effective frames (uncertainty/covariance.h)
//    and the spread of pooled units (problem/fit_problem.cc) are estimated at its optimum and the
//    fit solved on from there, until none changes by more than 1 %: the demand must not make the
//    data look worse than they are.
// 2. Where the fitted people do not settle in time, the fit is solved on with the demand, by the
//    same weights. Twice what the rest of the cost rises by is a likelihood ratio (composite,
//    adjusted; priors included) of as many constraints as units have people of their own to settle.
//    Beyond the 95 % point of chi-squared with so many degrees of freedom the data contradict the
//    demand: it is dropped, and the result says so. A constraint that need not bind has less than
//    one degree of freedom, so this keeps the demand too often rather than too seldom. Where no fit
//    that meets the demand is found, it is dropped as well.
#pragma once

#include <optional>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/loading/pendulum_recording.h"
#include "ident/fit/fit_setup.h"
#include "ident/model/fitted_model.h"
#include "ident/model/identified_model.h"
#include "ident/observed/first_frames.h"
#include "ident/parameters/fit_options.h"
#include "ident/problem/fit_point.h"
#include "ident/problem/fit_problem.h"
#include "ident/problem/parallel.h"
#include "ident/solver/solution.h"
#include "ident/solver/solver.h"
#include "ident/uncertainty/uncertainty.h"

namespace pushid {

struct WeightedSolution {
  Solution solution;
  SettlingDemand settling;
  std::optional<FitPoint> free;  // the optimum without the demand, where that binds and holds
  WorkLog work;                  // since the solve began
};

// problem: on return as it was weighed last, without a demand that was dropped.
WeightedSolution SolveWeighted(FitProblem* problem, const SolveProgress& progress = nullptr);

// Solves by rollouts (SolveWeighted), or by a likelihood of single steps (solver/solver.h), as the
// problem's options say.
WeightedSolution SolveFit(FitProblem* problem, const SolveProgress& progress = nullptr);

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
// a solve, or solved anew, of networks, which would remember what is held out. None of a fold
// without a usable optimum.
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

}  // namespace pushid
