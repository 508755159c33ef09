// ident: from starts to an optimum: equation error, horizon curriculum, multi-start.
#pragma once

#include <ceres/solver.h>

#include <string>
#include <vector>

#include "ident/problem/fit_problem.h"
#include "ident/solver/solution.h"

namespace pushid {

// Of the cost, where a network is fitted: what more would bring cannot be seen.
inline constexpr double kNetworkTolerance = 1e-6;

// The solver's settings: those of every fit, refit and reference check.
ceres::Solver::Options SolverOptions(const FitOptions& options, const ceres::Problem& problem);

// Solves what was built, from where its point stands.
SolveStage SolveBuilt(FitProblem::Built* built, const ceres::Solver::Options& options, int horizon,
                      std::string* message);

// All frames, or the likelihood, from a point near the optimum (profiles, bootstrap, leaving
// recordings out); in one thread where refits run in parallel. hold_network: its weights are
// constant.
SolveStart Refit(const FitProblem& problem, const FitPoint& from, bool hold_network = false,
                 int num_threads = 1);

// Of all blocks that can be rolled out from a point; infinite where a settling simulation cannot.
double CostAt(const FitProblem& problem, FitPoint point);

// Runs one start through the horizons.
SolveStart SolveFrom(const FitProblem& problem, const FitPoint& from, const std::string& kind,
                     const std::string& label, const SolveProgress& progress);

// The equation-error optimum, kept within a factor (log scale) or multiple (identity scale) of 5 of
// the nominal values, so that no start sits on a bound.
FitPoint EquationErrorStart(const FitProblem& problem);

// A start on a bound stalls: such values are moved inwards by a tenth of their typical size (on a
// log scale by 10 %). Returns what was moved, in words.
std::vector<std::string> MoveOffBounds(const FitProblem& problem, FitPoint* point);

// Of the i-th start, the first being 0.
std::uint64_t RandomStartSeed(const FitOptions& options, int i);
// The nominal point with every free gain multiplied by spread^u, u uniform in [-1, 1].
FitPoint RandomStart(const FitProblem& problem, double spread, uint64_t seed);

// All starts; the best usable one by cost, with fewer failed recordings winning first.
Solution Solve(const FitProblem& problem, const SolveProgress& progress = nullptr);

}  // namespace pushid
