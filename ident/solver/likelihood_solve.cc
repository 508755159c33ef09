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
constexpr double kSameCost = 1e-3;   // of a log likelihood, absolute
constexpr double kSameNoise = 0.01;  // the same, where only the noise is wanted
constexpr double kSettled = 0.01;    // relative change of a spread
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

struct NoiseFit {
  double cost = std::numeric_limits<double>::infinity();
  FitPoint at;
  std::string message;
};

// The likelihood's maximum over what is not held.
NoiseFit FitNoise(const FitProblem& problem, const std::vector<int>& held, const FitPoint& from) {
  NoiseFit fit;
  fit.at = from;
  for (int round = 0; round < kMostRounds; ++round) {
    const double before = fit.cost;
    fit.cost = SolveByBfgs(problem, held, &fit.at, &fit.message).final_cost;
    if (!std::isfinite(fit.cost) || std::abs(before - fit.cost) < kSameNoise) break;
  }
  return fit;
}

// The optimum of whole rollouts, roughly: from other values a likelihood of single steps may climb
// to a place where all roughness is force.
FitPoint RolloutStart(const FitProblem& problem) {
  FitOptions options = problem.options();
  options.likelihood = Likelihood::kTrajectory;
  options.function_tolerance = kRoughRollouts;
  const FitProblem rollouts(problem.recordings(), options, problem.counts());
  const FitPoint nominal = problem.NominalPoint();
  const SolveStart start = SolveFrom(rollouts, nominal, "nominal", "", nullptr);
  return start.usable ? start.to : nominal;
}

}  // namespace

LikelihoodSolution SolveByLikelihood(FitProblem* problem, const SolveProgress& progress) {
  const auto begin = std::chrono::steady_clock::now();
  LikelihoodSolution solved;
  std::vector<SolveStart>& starts = solved.solution.starts;
  const FitProblem as_asked = *problem;
  const FitOptions& asked = as_asked.options();
  for (int s = 0; s < asked.num_starts; ++s) {
    FitPoint from = s > 0 ? RandomStart(as_asked, asked.start_spread, RandomStartSeed(asked, s))
                          : RolloutStart(as_asked);
    FitProblem with_noise = WithNoise(as_asked, &from);
    FitOptions own = with_noise.options();
    const std::string label = asked.num_starts > 1 ? "start " + std::to_string(s + 1) + "/" +
                                                         std::to_string(asked.num_starts) + ", "
                                                   : "";
    own.horizons = {0};
    own.max_iterations = kScoringSteps;
    const FitProblem whole(as_asked.recordings(), own, as_asked.counts());
    SolveStart start = SolveFrom(whole, from, s > 0 ? "random" : "rollouts", label, progress);
    for (int round = 1; round < kScoringRounds; ++round) {
      start.to = SolveFrom(whole, start.to, start.kind, label, progress).to;
    }
    start.failed.clear();
    const bool stays = SolveOn(&with_noise, &start);
    start.usable = std::isfinite(start.cost) && start.failed.empty();
    const SolveStart* best = solved.solution.best < 0 ? nullptr : &solved.solution.Best();
    if (start.usable && (best == nullptr || start.cost < best->cost)) {
      solved.solution.best = s;
      solved.stays = stays;
      *problem = std::move(with_noise);
    }
    starts.push_back(std::move(start));
  }
  solved.solution.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return solved;
}

std::string EstimateNoise(const FitPoint& point, FitProblem* problem) {
  FitOptions options = problem->options();
  if (options.model.process_noise == ProcessNoise::kNone ||
      options.likelihood != Likelihood::kTrajectory) {
    return "";
  }
  const std::vector<PendulumRecording>& recordings = problem->recordings();
  FitOptions own = options;
  SetLikelihood(Likelihood::kInnovation, &own);
  FreeNoise(&own);
  for (ParameterSpec& spec : own.table.specs) {
    if (IsNoiseParameter(spec.id) && GivenByUser(spec)) spec.free = false;
  }
  StartNoise(*problem, point, kLowMeasurementError, &own);
  const FitProblem steps(recordings, own);
  FitPoint noise = steps.NominalPoint();
  noise.unit = point.unit;
  std::vector<int> held;
  const auto& fitted = steps.map().fitted;
  for (size_t i = 0; i < fitted.size(); ++i) {
    if (IsNoiseParameter(fitted[i].parameter)) continue;
    held.push_back(static_cast<int>(i));
    noise.shared[i] = point.shared[held.size() - 1];  // in table order, with the noise at its end
  }
  for (size_t i = fitted.size(); i < noise.Flat().size(); ++i) held.push_back(static_cast<int>(i));
  NoiseFit best;
  for (double error : kMeasurementErrors) {
    FitPoint from = noise;
    for (size_t i = 0; i < fitted.size(); ++i) {
      const ParameterSpec& spec = own.table[fitted[i].parameter];
      if (IsMeasurementError(spec.id) && spec.nominal == kLowMeasurementError) {
        from.shared[i] = ToFitted(spec.transform, error);
      }
    }
    const NoiseFit fit = FitNoise(steps, held, from);
    if (std::isfinite(fit.cost) ? fit.cost < best.cost : best.message.empty()) best = fit;
  }
  if (!std::isfinite(best.cost)) return "the process noise is not estimated: " + best.message;
  noise = best.at;
  const ParameterSet<double> found = steps.Parameters(noise, "");
  for (const FittedParameter& f : fitted) {
    if (!IsNoiseParameter(f.parameter)) continue;
    options.table[f.parameter].nominal = found[f.parameter];
  }
  *problem = FitProblem(recordings, std::move(options), problem->counts());
  return "";
}

LikelihoodScore ScoreByLikelihood(const FitProblem& problem, const FitPoint& point) {
  const Deviance deviance = problem.DevianceAt(point);
  return {deviance.value, deviance.measured, problem.map().num_shared()};
}

}  // namespace pushid
