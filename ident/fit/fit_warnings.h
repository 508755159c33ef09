// ident: what a reader of a fit must know before its numbers.
#pragma once

#include <string>
#include <vector>

#include "ident/model/fitted_model.h"
#include "ident/problem/fit_problem.h"

namespace pushid {

// Failed rollouts, a solver that stopped early, a verdict other than that people settle, few
// clusters, what the demand to settle did, parameters at bounds, a tail that cannot act.
Warnings FitWarnings(const FitProblem& problem, const FitResult& result);

}  // namespace pushid
