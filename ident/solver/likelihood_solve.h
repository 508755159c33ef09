// ident: a solve that maximizes a likelihood of single steps (residuals/likelihood.h).
//
// The noise starts at the spread of the transitions that the other parameters' start leaves, and
// equation error starts these. A problem's rows are Fisher scoring where it is built and end where
// the noise has fallen by a factor of 1.6 (residuals/gaussian_rows.h): it is built anew and solved
// on until the likelihood stays, as the spread of pooled units is estimated anew.
#pragma once

#include "ident/solver/likelihood_score.h"
#include "ident/solver/solver.h"

namespace pushid {

struct LikelihoodSolution {
  Solution solution;
  bool stays = false;  // the best one's likelihood, from round to round
};

// options: on return with the noise's start and the units' spread.
LikelihoodSolution SolveByLikelihood(const std::vector<PendulumRecording>& recordings,
                                     FitOptions* options, const SolveProgress& progress = nullptr);

// The process noise, and the errors of measurement, under which a fit of whole rollouts explains
// single steps best (innovation likelihood), everything else held at `point`: the table's fixed
// values on return. Nothing changes where the model has no noise, a likelihood of steps has found
// it already, or a filter leaves the domain.
void EstimateNoise(const std::vector<PendulumRecording>& recordings, const FitPoint& point,
                   FitOptions* options);

// At a point of a problem.
LikelihoodScore ScoreByLikelihood(const FitProblem& problem, const FitPoint& point);

}  // namespace pushid
