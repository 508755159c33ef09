// ident: a solve in turns with the estimate of how far units differ.
#pragma once

#include "ident/solver/solver.h"

namespace pushid {

// Solve; then, where the spread of pooled parameters is to be estimated, updates it at the best
// start's end and refits from there, until it changes by less than 1 %. table: the problem's own.
Solution SolvePooled(const FitProblem& problem, ParameterTable* table,
                     const SolveProgress& progress = nullptr);

}  // namespace pushid
