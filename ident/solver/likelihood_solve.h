// ident: a solve that maximizes a likelihood of single steps (residuals/fit_choices.h).
//
// The noise starts at the spread of the transitions that the other parameters' start leaves, and
// equation error starts these. A few steps of Fisher scoring
// (residuals/cost_functions/likelihood_residual.h), the problem built anew after every third, come
// near the optimum; BFGS finds it, in turns with the spread of pooled units.
#pragma once

#include <string>

#include "ident/solver/solution.h"
#include "ident/solver/solver.h"

namespace pushid {

struct LikelihoodSolution {
  Solution solution;
  bool stays = false;  // the best one's likelihood, from round to round
};

// The best of the starts, each on its own. problem: on return with the best one's start of the
// noise and its units' spread.
LikelihoodSolution SolveByLikelihood(FitProblem* problem, const SolveProgress& progress = nullptr);

// The process noise, and the errors of measurement, under which a fit of whole rollouts explains
// single steps best (innovation likelihood), everything else held at `point`: the fixed values of
// the problem's table on return. What the user has set stays. Nothing changes where the model has
// no noise, or a likelihood of steps has found it already. Returns a warning where it cannot be
// estimated.
std::string EstimateNoise(const FitPoint& point, FitProblem* problem);

// At a point of a problem.
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
// infinite, and message says why. held: columns of FitPoint::Flat that stay where they are, as
// those do that nothing depends on.
SolveStage SolveByBfgs(const FitProblem& problem, const std::vector<int>& held, FitPoint* point,
                       std::string* message);

}  // namespace pushid
