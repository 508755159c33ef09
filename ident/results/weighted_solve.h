// ident: a solve whose data weigh as much as they know, and in which the demand to settle is
// tested.
//
// 1. Sigmas and effective frames (uncertainty/data_weight.h) and the spread of pooled units
//    (problem/pooling_spread.h) are estimated and the fit solved on from there, until none changes
//    by more than 1 %.
// 2. Who settles in time as fitted is not moved by the demand at all. Otherwise the fit is solved
// on
//    without it, and weighed anew: the demand must not make the data look worse than they are.
// 3. With the same weights it is solved with the demand. Where twice the log likelihood (composite,
//    adjusted; priors included) falls by more than 3.84, chi-squared's 95 % point with one degree
//    of freedom, the data contradict the demand: it is dropped, and the result says so.
// With many columns (pooled groups) steps 2 and 3 would triple the time: the demand stays.
#pragma once

#include <optional>
#include <vector>

#include "ident/parameters/fit_options.h"
#include "ident/problem/fit_problem.h"
#include "ident/solver/solver.h"
#include "ident/uncertainty/uncertainty.h"

namespace pushid {

struct WeightedSolution {
  Solution solution;
  SettlingDemand settling;
  std::optional<FitPoint> free;  // the optimum without the demand, where that binds
};

// options: on return with what was estimated, and without a demand that was dropped.
WeightedSolution SolveWeighted(const std::vector<PendulumRecording>& recordings,
                               FitOptions* options, const SolveProgress& progress = nullptr);

}  // namespace pushid
