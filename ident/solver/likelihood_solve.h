// ident: a solve that maximizes a likelihood of single steps (residuals/frame_residual.h).
//
// It starts at the optimum of rollouts; the noise starts at the spread of the transitions
// that it leaves. A few steps of Fisher scoring (residuals/cost_functions/likelihood_residual.h),
// the problem built anew after every third, come near the optimum; BFGS finds it, in turns with the
// spread of pooled units.
#pragma once

#include <string>

#include "ident/solver/solution.h"

namespace pushid {

class FitProblem;

struct LikelihoodSolution {
  Solution solution;
  bool stays = false;  // the likelihood, from round to round
};

// problem: on return with the start of the noise and the units' spread.
LikelihoodSolution SolveByLikelihood(FitProblem* problem, const SolveProgress& progress = nullptr);

// The likelihood's score at a point of a problem.
LikelihoodScore ScoreByLikelihood(const FitProblem& problem, const FitPoint& point);

// BFGS on the exact cost of a likelihood, in coordinates that the Fisher information makes
// round.
//
// Fisher scoring by Gauss-Newton comes near an optimum in a few steps, and then creeps: where a
// model is wrong, as every model of people is, the curvature of its likelihood is not its Fisher
// information (each step took half of what was left on the 32 recordings of single people). BFGS
// learns the difference: x = origin + R z with R R' the inverse information at the origin, so that
// its first step is the scoring's own. Numbers on a bound that the gradient pushes outwards are
// held there.
//
// From *point, whose value is overwritten; where nothing can be evaluated it stays, the cost is
// infinite, and message says why. Numbers that
// nothing depends on stay where they are.
SolveStage SolveByBfgs(const FitProblem& problem, FitPoint* point, std::string* message);

}  // namespace pushid
