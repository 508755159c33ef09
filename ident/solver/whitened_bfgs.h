// ident: BFGS on the exact cost of a likelihood, in coordinates that the Fisher information makes
// round.
//
// Fisher scoring by Gauss-Newton comes near an optimum in a few steps, and then creeps: where a
// model is wrong, as every model of people is, the curvature of its likelihood is not its Fisher
// information (each step took half of what was left on the 32 recordings of single people). BFGS
// learns the difference: x = origin + R z with R R' the inverse information at the origin, so that
// its first step is the scoring's own. Numbers on a bound that the gradient pushes outwards are
// held there.
#pragma once

#include "ident/problem/fit_problem.h"
#include "ident/solver/solution.h"

namespace pushid {

// From *point, whose value is overwritten; where nothing can be evaluated it stays, the cost is
// infinite, and message says why. held: columns of FitPoint::Flat that stay where they are, as
// those do that nothing depends on.
SolveStage SolveByBfgs(const FitProblem& problem, const std::vector<int>& held, FitPoint* point,
                       std::string* message);

}  // namespace pushid
