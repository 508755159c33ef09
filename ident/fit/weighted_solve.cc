// ident: solving and weighing in turn.
#include "ident/fit/weighted_solve.h"

#include <algorithm>
#include <cmath>

#include "ident/problem/behaviour.h"
#include "ident/problem/fit_problem.h"
#include "ident/problem/parallel.h"
#include "ident/problem/statistics.h"
#include "ident/solver/solver.h"
#include "ident/uncertainty/clusters.h"

namespace pushid {
namespace {

constexpr double kSettled = 0.01;  // relative change
constexpr int kMostRounds = 20;
constexpr int kFewIterations = 4;  // of a rough round: by weights that will change
constexpr double kRough = 1e-3;    // function tolerance on the way
// The demand joins in three steps, each solved to its own optimum: all of it at once outweighs
// everything else where people are far from settled, and the solver creeps along its edge. A
// twentieth moves the optimum near the edge, and from there along it by steps of ordinary length.
constexpr double kDemandSteps[] = {0.05, 0.3, 1.0};
constexpr double kLessExact = 100.0;  // function tolerances, of the steps before the last
// Probability of a rise of twice the cost, below which the data contradict the demand.
constexpr double kImprobable = 0.05;

double Change(double from, double to) {
  return from > 0.0 && to > 0.0 ? std::abs(std::log(to / from)) : 1.0;
}

// What the problem's parts weigh by what is known at a point, and the recordings' sums by these
// weights; the largest relative change.
double Reweigh(FitProblem problem, const FitPoint& point, CostWeights* weights,
               RecordingSums* recordings) {
  const FitOptions options = problem.options();
  double change = 0.0;
  if (EstimatesSigmas(options)) {
    const ResidualSigmas& before = options.sigmas;
    const ResidualSigmas now = weights->sigmas = EstimateSigmas(problem, point);
    for (const auto& [a, b] : {std::pair(before.hip, now.hip),
                               {before.velocity, now.velocity},
                               {before.angle, now.angle},
                               {before.rate, now.rate}}) {
      change = std::max(change, Change(a, b));
    }
    problem.SetWeights(*weights);  // the effective weight is that of residuals in these sigmas
  }
  if (options.estimate_weights) {
    weights->effective_weight = EstimateEffectiveWeight(problem, point, recordings);
    change = std::max(change, Change(options.effective_weight, weights->effective_weight));
  }
  return std::max(change, UpdatePoolingSpread(problem, point, weights));
}

// Optima on the way to the final one need not be exact.
FitProblem WithRoughTolerance(FitProblem problem) {
  problem.set_function_tolerance(std::max(kRough, problem.options().function_tolerance));
  return problem;
}

// For solves between two estimates of the weights.
FitProblem WithFewIterations(const FitProblem& problem) {
  FitProblem rough = WithRoughTolerance(problem);
  const FitOptions& options = problem.options();
  if (options.model.learned == nullptr) {
    rough.set_max_iterations(std::min(kFewIterations, options.max_iterations));
  }
  return rough;
}

// For solves with a share of a demand.
FitProblem WithLooserTolerance(FitProblem problem) {
  problem.set_function_tolerance(kLessExact * problem.options().function_tolerance);
  return problem;
}

// Where recordings were summed up none of them fails.
std::vector<FailedRollout> FailuresAfter(const FitProblem& problem, const SolveStart& start) {
  if (start.recordings.at.size() > 0) return {};
  return problem.Failures(start.to, 0);
}

// From the optimum under other weights to that under these.
void SolveOn(const FitProblem& problem, SolveStart* start) {
  SolveStart again =
      Refit(problem, start->to, problem.options().num_threads, std::move(start->recordings));
  start->stages.insert(start->stages.end(), again.stages.begin(), again.stages.end());
  start->iterations += again.iterations;
  start->to = std::move(again.to);
  start->recordings = std::move(again.recordings);
  start->cost = again.cost;
  start->converged = again.converged;
  start->message = std::move(again.message);
}

// Solves and estimates the weights in turns: with a rough tolerance until the weights settle, then
// exactly until they settle again. False where they do not.
bool SolveAndReweigh(FitProblem* problem, SolveStart* start) {
  bool exact = false;
  for (int round = 0; round < kMostRounds; ++round) {
    CostWeights now = problem->weights();
    RecordingSums recordings;
    const bool settled = Reweigh(*problem, start->to, &now, &recordings) < kSettled;
    if (settled && exact) return true;
    exact = exact || settled;
    if (!settled) {
      problem->SetWeights(now);
      start->recordings = std::move(recordings);
    }
    SolveOn(exact ? *problem : WithFewIterations(*problem), start);
  }
  if (!exact) SolveOn(*problem, start);
  return false;
}

// Seconds until the slowest simulated person has settled.
double SlowestSeconds(const FitProblem& problem, const FitPoint& point) {
  double slowest = 0.0;
  for (const std::string& unit : problem.SettlingUnits(point)) {
    slowest =
        std::max(slowest, SettlingSeconds(problem.ModelAt(point), problem.Parameters(point, unit)));
  }
  return slowest;
}

// A fit that meets the demand, from one that does not. Where simulated people fall or run out of
// the domain there, Ceres cannot see them: then on the way from the start, where they need not.
SolveStart SolveHeld(const FitProblem& demanding, const SolveStart& free) {
  FitProblem part = demanding;
  SolveStart held = free;
  for (double share : kDemandSteps) {
    part.set_settling_weight(share * demanding.options().settling_weight);
    if (share == kDemandSteps[0] && std::isinf(CostAt(part.WithoutRecordings(), free.to))) {
      held = SolveFrom(WithRoughTolerance(part), part.NominalPoint(), "nominal", nullptr);
    } else {
      SolveOn(share < 1.0 ? WithLooserTolerance(part) : part, &held);
    }
  }
  held.failed = FailuresAfter(demanding, held);
  return held;
}

// Step 2 of the header, from the optimum without the demand.
void Demand(double weight, FitProblem* problem, WeightedSolution* solved) {
  SolveStart& best = solved->solution.start;
  const FitProblem without = *problem;
  problem->set_settling_weight(weight);
  const FitProblem demands = problem->WithoutRecordings();
  if (CostAt(demands, best.to) == CostAt(without.WithoutRecordings(), best.to)) return;
  SolveStart held = SolveHeld(*problem, best);

  SettlingDemand& settling = solved->settling;
  settling.binds = true;
  settling.free_seconds = SlowestSeconds(without, best.to);
  settling.unmet = !held.converged || held.failed.size() > best.failed.size() ||
                   std::isinf(CostAt(demands, held.to));
  if (!settling.unmet) {
    settling.rise = std::max(0.0, 2.0 * (CostAt(without, held.to) - best.cost));
    const int units = static_cast<int>(without.SettlingUnits(best.to).size());
    settling.contradicted = ChiSquareTail(settling.rise, units) < kImprobable;
    settling.unmet = !settling.contradicted &&
                     SlowestSeconds(*problem, held.to) > WaitSeconds(problem->options().model);
  }
  if (!settling.holds()) {
    problem->set_settling_weight(0.0);
    return;
  }
  solved->free = best.to;
  best = std::move(held);
  best.usable = true;
}

}  // namespace

WeightedSolution SolveWeighted(FitProblem* problem, const SolveProgress& progress) {
  const double begin = Now();
  const double weight = problem->options().settling_weight;
  problem->set_settling_weight(0.0);
  WeightedSolution solved;
  Solution& solution = solved.solution;
  solution = Solve(WithRoughTolerance(*problem), progress);
  solved.work.Add("starts and horizons");
  if (!solution.ok()) {
    problem->set_settling_weight(weight);
    return solved;
  }
  SolveStart& best = solution.start;
  solved.weights_settled = SolveAndReweigh(problem, &best);
  best.failed = FailuresAfter(*problem, best);
  solved.work.Add("weights");
  Demand(weight, problem, &solved);
  solved.work.Add("settling");
  best.recordings = {};
  solution.seconds = Now() - begin;
  return solved;
}

WeightedSolution SolveFit(FitProblem* problem, const SolveProgress& progress) {
  if (problem->options().likelihood == Likelihood::kTrajectory) {
    return SolveWeighted(problem, progress);
  }
  LikelihoodSolution by_steps = SolveByLikelihood(problem, progress);
  WeightedSolution solved;
  solved.solution = std::move(by_steps.solution);
  solved.weights_settled = by_steps.stays;
  solved.work.Add("likelihood");
  return solved;
}

}  // namespace pushid
