// ident: solving and weighing in turn.
#include "ident/results/weighted_solve.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "ident/problem/behaviour.h"
#include "ident/problem/pooling_spread.h"
#include "ident/uncertainty/data_weight.h"

namespace pushid {
namespace {

constexpr double kSettled = 0.01;  // relative change
constexpr int kMostRounds = 12;
constexpr double kRough = 1e-5;         // function tolerance between rounds
constexpr double kContradicted = 3.84;  // of twice the log likelihood
constexpr size_t kMostColumnsToTest = 60;

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
    for (const auto& [a, b] : {std::pair(before.hip, now.hip),
                               {before.velocity, now.velocity},
                               {before.angle, now.angle},
                               {before.rate, now.rate}}) {
      change = std::max(change, Change(a, b));
    }
  }
  if (options->recording_weight == RecordingWeight::kEffective) {
    const double weight = options->effective_weight;
    options->effective_weight = EstimateEffectiveWeight(problem, point);
    change = std::max(change, Change(weight, options->effective_weight));
  }
  return std::max(change, UpdatePoolingSpread(problem, point, &options->table));
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

// Weighs and solves in turns, from a start that was solved.
void Weigh(const std::vector<PendulumRecording>& recordings, FitOptions* options,
           SolveStart* best) {
  bool changed = false;
  for (int round = 0; round < kMostRounds; ++round) {
    FitOptions now = *options;
    if (Reweigh(FitProblem(recordings, *options), best->to, &now) < kSettled) break;
    *options = now;
    // On the way the optimum need not be exact.
    now.function_tolerance = std::max(kRough, now.function_tolerance);
    SolveOn(recordings, now, best);
    changed = true;
  }
  if (changed) SolveOn(recordings, *options, best);
}

// Half of what the demand to settle adds to the cost at a point.
double SettlingCost(const FitProblem& problem, const FitPoint& point) {
  FitPoint copy = point;
  const FitProblem::Built built = problem.Build(&copy, 0);
  double sum = 0.0;
  for (const auto& [id, cluster] : built.blocks) {
    if (cluster != FitProblem::kSettlingCluster) continue;
    double cost = 0.0;
    built.problem->EvaluateResidualBlock(id, false, &cost, nullptr, nullptr);
    sum += cost;
  }
  return built.rests_left_out > 0 ? std::numeric_limits<double>::infinity() : sum;
}

// Steps 2 and 3 of the header, for a fit that a demand of `weight` holds.
void TestDemand(const std::vector<PendulumRecording>& recordings, double weight,
                FitOptions* options, WeightedSolution* solved) {
  SolveStart& best = solved->solution.starts[solved->solution.best];
  FitOptions freed = *options;
  freed.settling_weight = 0.0;
  SolveStart free = best;
  SolveOn(recordings, freed, &free);
  Weigh(recordings, &freed, &free);
  FitOptions demanding = freed;
  demanding.settling_weight = weight;
  SolveStart held = best;
  SolveOn(recordings, demanding, &held);
  const FitProblem with(recordings, demanding), without(recordings, freed);
  // What the rest of the cost rises by. Demands that stay (on the modes) are in both.
  const double rise =
      held.cost - SettlingCost(with, held.to) + SettlingCost(without, held.to) - free.cost;
  solved->settling.binds = true;
  solved->settling.rise = 2.0 * rise;
  solved->settling.free_seconds =
      SettlingSeconds(without.ModelAt(free.to), without.Parameters(free.to, ""));
  solved->settling.contradicted = !held.converged || 2.0 * rise > kContradicted;
  if (!solved->settling.contradicted) solved->free = free.to;
  best = solved->settling.contradicted ? free : held;
  *options = solved->settling.contradicted ? freed : demanding;
}

}  // namespace

WeightedSolution SolveWeighted(const std::vector<PendulumRecording>& recordings,
                               FitOptions* options, const SolveProgress& progress) {
  const auto begin = std::chrono::steady_clock::now();
  WeightedSolution solved;
  Solution& solution = solved.solution;
  solution = Solve(FitProblem(recordings, *options), progress);
  if (solution.best >= 0) {
    SolveStart& best = solution.starts[solution.best];
    Weigh(recordings, options, &best);
    const double weight = options->settling_weight;
    FitOptions freed = *options;
    freed.settling_weight = 0.0;
    const bool binds = weight > 0.0 && SettlingCost(FitProblem(recordings, *options), best.to) >
                                           SettlingCost(FitProblem(recordings, freed), best.to);
    if (binds && best.to.Flat().size() <= kMostColumnsToTest) {
      TestDemand(recordings, weight, options, &solved);
    }
  }
  solution.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return solved;
}

}  // namespace pushid
