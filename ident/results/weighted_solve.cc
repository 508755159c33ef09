// ident: solving and weighing in turn.
#include "ident/results/weighted_solve.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "ident/uncertainty/data_weight.h"

namespace pushid {
namespace {

constexpr double kSettled = 0.01;  // relative change
constexpr int kMostRounds = 12;
constexpr double kRough = 1e-5;  // function tolerance between rounds

double Change(double from, double to) {
  return from > 0.0 && to > 0.0 ? std::abs(std::log(to / from)) : 1.0;
}

// Estimates anew; the largest relative change.
double Reweigh(const FitProblem& problem, const FitPoint& point, FitOptions* options) {
  double change = 0.0;
  const ResidualSigmas before = options->sigmas;
  if (options->sigma_source == SigmaSource::kEstimate) {
    options->sigmas = EstimateSigmas(problem, point);
    const ResidualSigmas& now = options->sigmas;
    for (const auto& [a, b] : {std::pair(before.hip, now.hip), {before.velocity, now.velocity},
                               {before.angle, now.angle}, {before.rate, now.rate}}) {
      change = std::max(change, Change(a, b));
    }
  }
  if (options->recording_weight == RecordingWeight::kEffective) {
    const double weight = options->effective_weight;
    options->effective_weight = EstimateEffectiveWeight(problem, point);
    change = std::max(change, Change(weight, options->effective_weight));
  }
  return change;
}

// From the optimum under other weights to that under these.
void SolveOn(const std::vector<PendulumRecording>& recordings, const FitOptions& options,
             SolveStart* start) {
  const FitProblem problem(recordings, options);
  SolveStart again = Refit(problem, start->to);
  start->stages.insert(start->stages.end(), again.stages.begin(), again.stages.end());
  start->iterations += again.iterations;
  start->to = std::move(again.to);
  start->cost = again.cost;
  start->converged = again.converged;
  start->failed = problem.Failures(start->to, 0);
  start->message = std::move(again.message);
}

}  // namespace

Solution SolveWeighted(const std::vector<PendulumRecording>& recordings, FitOptions* options,
                       const SolveProgress& progress) {
  const auto begin = std::chrono::steady_clock::now();
  Solution solution = Solve(FitProblem(recordings, *options), progress);
  bool changed = false;
  for (int round = 0; solution.best >= 0 && round < kMostRounds; ++round) {
    SolveStart& best = solution.starts[solution.best];
    FitOptions now = *options;
    if (Reweigh(FitProblem(recordings, *options), best.to, &now) < kSettled) break;
    *options = now;
    // On the way the optimum need not be exact.
    now.function_tolerance = std::max(kRough, now.function_tolerance);
    SolveOn(recordings, now, &best);
    changed = true;
  }
  if (changed) SolveOn(recordings, *options, &solution.starts[solution.best]);
  solution.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return solution;
}

}  // namespace pushid
