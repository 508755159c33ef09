// ident: what the estimates become where the priors were others: centres and widths halved, doubled.
//
// A parameter that the recordings know keeps its value. Profiles and bootstrap cannot tell: they
// carry the same priors.
#pragma once

#include <string>
#include <vector>

#include "ident/problem/fit_problem.h"
#include "ident/uncertainty/uncertainty.h"

namespace pushid {

struct PriorCheckRow {
  std::string name, unit;
  double halved = 0.0, value = 0.0, doubled = 0.0;  // natural unit
  bool inside = true;  // both within the 95 % interval
};

// Refits from the estimate, at the same weights of the data. Empty where no free parameter has a
// prior, or where a refit fails.
std::vector<PriorCheckRow> CheckPriors(const FitProblem& problem, const FitPoint& estimate,
                                       const Uncertainty& uncertainty);

}  // namespace pushid
