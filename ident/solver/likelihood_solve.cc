// ident: rounds of building and solving by a likelihood.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>

#include "ident/parameters/presets.h"
#include "ident/problem/fit_problem.h"
#include "ident/solver/solver.h"
#include "models/parameters.h"
#include "residuals/cost_functions/likelihood_residual.h"

namespace pushid {
namespace {

constexpr int kMostRounds = 30;
constexpr double kSameCost = 1e-3;  // of a log likelihood, absolute
constexpr double kSettled = 0.01;   // relative change of a spread
// Noise starts too low rather than too high: rows end where it has fallen far, and never where it
// rises. Of what transitions leave, measured velocities err too.
constexpr double kShareOfNoise = 0.1;
constexpr double kLowMeasurementError = 3e-4;  // m
// The likelihood of the noise has two basins: all roughness is force, or most of it errors of
// measurement.
constexpr double kMeasurementErrors[] = {kLowMeasurementError, 3e-3};

constexpr double kRoughRollouts = 1e-3;  // function tolerance

// Steps of Fisher scoring before BFGS.
constexpr int kScoringRounds = 3, kScoringSteps = 3;

// Root mean squares of what the model leaves of the transitions, as sigmas.
Vector4<double> SpreadOfTransitions(const FitProblem& problem, const FitPoint& point) {
  ParameterSet<double> p = problem.Parameters(point, "");
  for (int i = 0; i < 4; ++i) p[kSigmaX + i] = 1.0;
  Vector4<double> sum = Vector4<double>::Zero();
  int count = 0;
  for (const PendulumRecording& recording : problem.recordings()) {
    ModelOptions model = problem.options().model;
    model.process_noise = ProcessNoise::kNone;
    const LikelihoodProblem one =
        MakeLikelihoodProblem(Likelihood::kTransition, recording, model, problem.map(), 1.0);
    std::vector<GaussianDensity<double>> densities;
    Densities<double>(one, std::vector<ParameterSet<double>>(recording.num_people(), p),
                      &densities);
    for (const GaussianDensity<double>& density : densities) {
      if (!density.measured) continue;
      sum += density.v.cwiseQuotient(density.lower.diagonal()).cwiseAbs2();
      ++count;
    }
  }
  return (sum / std::max(1, count)).cwiseSqrt();
}

bool GivenByUser(const ParameterSpec& spec) {
  return spec.nominal != AllParameterFacts()[spec.id].nominal;
}

// Where the user has given no other start; error: of measurement, m.
void StartNoise(const FitProblem& problem, const FitPoint& point, double error,
                FitOptions* options) {
  const Vector4<double> spread = SpreadOfTransitions(problem, point);
  for (int i = 0; i < 4; ++i) {
    ParameterSpec& spec = options->table.specs[kSigmaX + i];
    if (!spec.free || GivenByUser(spec)) continue;
    spec.nominal = std::clamp(kShareOfNoise * spread[i], 2.0 * spec.lower, 0.5 * spec.upper);
  }
  for (Parameter id : {kMeasuredCart, kMeasuredHip}) {
    ParameterSpec& spec = options->table[id];
    if (spec.free && !GivenByUser(spec)) spec.nominal = error;
  }
}

// The noise's starts, at a point of the other parameters.
void TakeNoise(const FitProblem& problem, FitPoint* point) {
  const FitPoint nominal = problem.NominalPoint();
  const auto& fitted = problem.map().fitted;
  for (size_t i = 0; i < fitted.size(); ++i) {
    if (IsNoiseParameter(fitted[i].parameter)) point->shared[i] = nominal.shared[i];
  }
}

// With the likelier of the noise's starts, which the point takes.
FitProblem WithNoise(const FitProblem& problem, FitPoint* point) {
  std::optional<FitProblem> best;
  FitPoint best_point;
  double least = std::numeric_limits<double>::infinity();
  for (double error : kMeasurementErrors) {
    FitOptions options = problem.options();
    StartNoise(problem, *point, error, &options);
    FitProblem with(problem.recordings(), std::move(options), problem.counts());
    FitPoint at = *point;
    TakeNoise(with, &at);
    const double deviance = with.DevianceAt(at).value;
    if (best && !(deviance < least)) continue;
    least = deviance;
    best.emplace(std::move(with));
    best_point = std::move(at);
  }
  *point = std::move(best_point);
  return *std::move(best);
}

// BFGS, and the units' spread anew, in turns. Whether the likelihood stays.
bool SolveOn(FitProblem* problem, SolveStart* start) {
  for (int round = 0; round < kMostRounds; ++round) {
    CostWeights weights = problem->weights();
    const double spread = UpdatePoolingSpread(*problem, start->to, &weights);
    problem->Weigh(weights);
    const SolveStage stage = SolveByBfgs(*problem, {}, &start->to, &start->message);
    const double before = start->cost;
    start->stages.push_back(stage);
    start->iterations += stage.iterations;
    start->cost = stage.final_cost;
    start->converged = stage.converged;
    if (!std::isfinite(start->cost)) return false;
    const bool stays = std::abs(before - start->cost) < kSameCost && spread < kSettled;
    if (stays && start->converged) return true;
  }
  return false;
}

// The optimum of whole rollouts, roughly: from other values a likelihood of single steps may climb
// to a place where all roughness is force.
FitPoint RolloutStart(const FitProblem& problem) {
  FitOptions options = problem.options();
  options.likelihood = Likelihood::kTrajectory;
  options.function_tolerance = kRoughRollouts;
  const FitProblem rollouts(problem.recordings(), options, problem.counts());
  const FitPoint nominal = problem.NominalPoint();
  const SolveStart start = SolveFrom(rollouts, nominal, "nominal", nullptr);
  return start.usable ? start.to : nominal;
}

}  // namespace

LikelihoodSolution SolveByLikelihood(FitProblem* problem, const SolveProgress& progress) {
  const auto begin = std::chrono::steady_clock::now();
  LikelihoodSolution solved;
  FitPoint from = RolloutStart(*problem);
  FitProblem with_noise = WithNoise(*problem, &from);
  FitOptions own = with_noise.options();
  own.horizons = {0};
  own.max_iterations = kScoringSteps;
  const FitProblem whole(problem->recordings(), own, problem->counts());
  SolveStart& start = solved.solution.start;
  start = SolveFrom(whole, from, "rollouts", progress);
  for (int round = 1; round < kScoringRounds; ++round) {
    start.to = SolveFrom(whole, start.to, start.kind, progress).to;
  }
  start.failed.clear();
  solved.stays = SolveOn(&with_noise, &start);
  start.usable = std::isfinite(start.cost) && start.failed.empty();
  if (start.usable) *problem = std::move(with_noise);
  solved.solution.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return solved;
}

LikelihoodScore ScoreByLikelihood(const FitProblem& problem, const FitPoint& point) {
  const Deviance deviance = problem.DevianceAt(point);
  return {deviance.value, deviance.measured, problem.map().num_shared()};
}

}  // namespace pushid
