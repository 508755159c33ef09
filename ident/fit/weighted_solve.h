// ident: a solve whose data weigh as much as they know, and in which the demand to settle is
// tested.
//
// 1. The fit is solved without the demand. Sigmas and effective frames (uncertainty/clusters.h)
//    and the spread of pooled units (problem/fit_problem.cc) are estimated at its optimum and
//    the fit solved on from there, until none changes by more than 1 %: the demand must not make
//    the data look worse than they are.
// 2. Who settles in time as fitted is not moved by the demand at all. Otherwise the fit is solved
//    on with the demand, by the same weights. Twice what the rest of the cost rises by is a
//    likelihood ratio (composite, adjusted; priors included) of as many constraints as units have
//    people of their own to settle. Beyond the 95 % point of chi-squared with so many degrees of
//    freedom the data contradict the demand: it is dropped, and the result says so. A constraint
//    that need not bind has less than one degree of freedom, so this keeps the demand too often
//    rather than too seldom. Where no fit that meets the demand is found, it is dropped as well.
#pragma once

#include <optional>
#include <vector>

#include "ident/parameters/fit_options.h"
#include "ident/problem/fit_problem.h"
#include "ident/problem/work.h"
#include "ident/solver/solver.h"
#include "ident/uncertainty/uncertainty.h"

namespace pushid {

struct WeightedSolution {
  Solution solution;
  bool weights_settled = false;  // within 1 %
  SettlingDemand settling;
  std::optional<FitPoint> free;  // the optimum without the demand, where that binds and holds
  WorkLog work;                  // since the solve began
};

// problem: on return as it was weighed last, without a demand that was dropped.
WeightedSolution SolveWeighted(FitProblem* problem, const SolveProgress& progress = nullptr);

// By rollouts as above, or by a likelihood of single steps (solver/solver.h), as the
// problem's options say.
WeightedSolution SolveFit(FitProblem* problem, const SolveProgress& progress = nullptr);

}  // namespace pushid
