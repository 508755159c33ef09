// ident: from a start to an optimum by growing horizons.
#pragma once

#include <ceres/solver.h>

#include <string>
#include <vector>

#include "ident/problem/fit_problem.h"
#include "ident/solver/solution.h"
#include "ident/solver/structured_secants.h"

namespace pushid {

// The solver's settings: those of every fit, refit and reference check.
ceres::Solver::Options SolverOptions(const FitOptions& options, const ceres::Problem& problem);

// Solves what was built, from where its point stands. secants: whether to learn curvature (no: far
// from an optimum, where one step says little about the next). recordings: what is known where it
// begins, and on return where it ended.
SolveStage SolveBuilt(FitProblem::Built* built, const ceres::Solver::Options& options, int horizon,
                      std::string* message, StructuredSecants secants,
                      RecordingSums* recordings = nullptr);

// All frames, or the likelihood, from a point near the optimum (profiles, bootstrap, leaving
// recordings out); in one thread where refits run in parallel. known: at `from`, by the
// weights of the problem.
SolveStart Refit(const FitProblem& problem, const FitPoint& from, int num_threads = 1,
                 RecordingSums known = {});

// The cost of all blocks that can be rolled out; infinite where a settling simulation cannot.
double CostAt(const FitProblem& problem, FitPoint point);

// Runs one start through the horizons.
SolveStart SolveFrom(const FitProblem& problem, const FitPoint& from, const std::string& kind,
                     const SolveProgress& progress);

// A start on a bound stalls: such values are moved inwards by a tenth of their typical size (on a
// log scale by 10 %). Returns what was moved, in words.
std::vector<std::string> MoveOffBounds(const FitProblem& problem, FitPoint* point);

// From the nominal point.
Solution Solve(const FitProblem& problem, const SolveProgress& progress = nullptr);

// Networks too large for Gauss-Newton.

// The fit without its network.
FitOptions PhysicsAlone(FitOptions options);

// Trains a large network together with the free parameters (large_networks/large_network_fit.h).
// Returns the options with the trained network, held, and the parameters' values to start from.
// Errors: what the adjoint gradient refuses (free initial velocities).
using LargeNetworkTrainer = Result<FitOptions> (*)(const std::vector<PendulumRecording>& recordings,
                                                   const FitOptions& options,
                                                   const SolveProgress& progress);
// Set by the library pushid_large_networks in programs that link it, elsewhere null.
LargeNetworkTrainer& LargeNetworkTraining();
// Errors: this program does not link it.
Result<FitOptions> TrainLargeNetwork(const std::vector<PendulumRecording>& recordings,
                                     const FitOptions& options, const SolveProgress& progress);

// Maximizes a likelihood of single steps (residuals/frame_residual.h), from the optimum of
// rollouts; the noise starts at the spread of the transitions that it leaves. A few steps of Fisher
// scoring (residuals/cost_functions/likelihood_residual.h), the problem built anew after every
// third, come near the optimum; BFGS finds it, in turns with the spread of pooled units. problem:
// on return with the start of the noise and the units' spread.
Solution SolveByLikelihood(FitProblem* problem, const SolveProgress& progress = nullptr);

// The likelihood's score at a point of a problem.
LikelihoodScore ScoreByLikelihood(const FitProblem& problem, const FitPoint& point);

// BFGS on the exact cost of a likelihood, in coordinates that the Fisher information makes round.
//
// Fisher scoring by Gauss-Newton comes near an optimum in a few steps, and then creeps: where a
// model is wrong, as every model of people is, the curvature of its likelihood is not its Fisher
// information (each step took half of what was left on the 32 recordings of single people). BFGS
// learns the difference: x = origin + R z with R R' the inverse information at the origin, so that
// its first step is the scoring's own. Numbers on a bound that the gradient pushes outwards are
// held there, and those that nothing depends on stay. Where nothing can be evaluated *point stays,
// the cost is infinite, and message says why.
SolveStage SolveByBfgs(const FitProblem& problem, FitPoint* point, std::string* message);

}  // namespace pushid
