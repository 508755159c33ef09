// ident: from a point near the optimum to the optimum.
#include <algorithm>
#include <unsupported/Eigen/SpecialFunctions>

#include "ident/solver/solver.h"

namespace pushid {
namespace {

// Where demands begin and contacts close, steps shrink with the trust region until one is within
// the tolerance, which is no optimum: from such an end a fresh region goes on, without what secants
// learned, while it brings more than so many tolerances.
constexpr double kWorthAnother = 50.0;
constexpr int kMostFresh = 5;

}  // namespace

bool Contradicted(double rise, size_t units) {
  constexpr double kImprobable = 0.05;
  return Eigen::numext::igammac(0.5 * static_cast<double>(units), 0.5 * std::max(0.0, rise)) <
         kImprobable;
}

SolveStart Refit(const FitProblem& problem, const FitPoint& from, bool hold_network,
                 int num_threads, RecordingSums known) {
  SolveStart start;
  start.kind = "warm";
  start.from = start.to = from;
  if (problem.options().likelihood != Likelihood::kTrajectory) {
    const SolveStage stage = SolveByBfgs(problem, {}, &start.to, &start.message);
    start.stages.push_back(stage);
    start.iterations = stage.iterations;
    start.cost = stage.final_cost;
    start.converged = start.usable = stage.converged;
    return start;
  }
  start.recordings = std::move(known);
  const bool network = !from.weights.empty() && !hold_network;
  const auto solve = [&] {
    const std::vector<double> at = start.to.Flat();
    const bool all_inside = start.recordings.AreAt(
        Eigen::Map<const Eigen::VectorXd>(at.data(), static_cast<Eigen::Index>(at.size())));
    FitProblem::Built built = problem.Build(&start.to, 0, hold_network, num_threads, all_inside);
    ceres::Solver::Options solver = SolverOptions(problem.options(), *built.problem);
    if (network) solver.function_tolerance = std::max(kNetworkTolerance, solver.function_tolerance);
    const SolveStage stage =
        SolveBuilt(&built, solver, 0, &start.message, StructuredSecants(true), &start.recordings);
    start.failed = std::move(built.shortened);
    start.stages.push_back(stage);
    start.iterations += stage.iterations;
    start.cost = stage.final_cost;
    start.converged = stage.converged;
  };
  solve();
  const double worth = kWorthAnother * problem.options().function_tolerance;
  for (int fresh = 0; !network && start.converged && fresh < kMostFresh; ++fresh) {
    const SolveStage& last = start.stages.back();
    if (!last.cramped || last.initial_cost - last.final_cost <= worth * last.initial_cost) break;
    solve();
  }
  start.usable = start.converged && start.failed.empty();
  return start;
}

}  // namespace pushid
