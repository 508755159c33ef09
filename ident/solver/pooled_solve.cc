// ident: spread and point in turns.
#include "ident/solver/pooled_solve.h"

#include "ident/problem/pooling_spread.h"

namespace pushid {
namespace {

constexpr int kMostTurns = 10;
constexpr double kSettledSpread = 0.01;

}  // namespace

Solution SolvePooled(const FitProblem& problem, ParameterTable* table,
                     const SolveProgress& progress) {
  Solution solution = Solve(problem, progress);
  if (solution.best < 0) return solution;
  SolveStart& best = solution.starts[solution.best];
  for (int turn = 0; turn < kMostTurns; ++turn) {
    if (UpdatePoolingSpread(problem, best.to, table) < kSettledSpread) break;
    SolveStart refit = Refit(problem, best.to);
    best.to = refit.to;
    best.cost = refit.cost;
    best.converged = refit.converged;
    best.failed = refit.failed;
    best.iterations += refit.iterations;
    best.stages.insert(best.stages.end(), refit.stages.begin(), refit.stages.end());
    best.message = refit.message;
  }
  return solution;
}

}  // namespace pushid
