// ident: a fit, from recordings to a judged result.
#include "ident/fit/fit.h"

#include <optional>

#include "ident/fit/estimates_table.h"
#include "ident/fit/fit_warnings.h"
#include "ident/fit/push_range.h"
#include "ident/fit/recording_effect.h"
#include "ident/fit/step_probability.h"
#include "ident/fit/weighted_solve.h"
#include "ident/solver/likelihood_solve.h"
#include "ident/uncertainty/uncertainty.h"
#include "residuals/takeover.h"

namespace pushid {
namespace {

// A solve, with the options as they were estimated on the way.
struct SolvedFit {
  FitOptions options;
  WeightedSolution solved;
  std::vector<EnsembleMember> others;
  std::string no_noise;  // a warning

  bool ok() const { return solved.solution.best >= 0; }
  const SolveStart& Best() const { return solved.solution.Best(); }
};

// What judging and folds have in common. Errors: a large network's physical model alone has no
// usable optimum; without one of the whole, the result is not ok().
Result<SolvedFit> SolveFit(const std::vector<PendulumRecording>& recordings,
                           const FitOptions& options, const SolveProgress& progress) {
  const Result<FitOptions> trained = WithLargeNetworkTrained(recordings, options, progress);
  if (!trained.ok()) return trained.error();
  SolvedFit fit;
  fit.options = trained.value();
  fit.solved = SolveAsAsked(recordings, &fit.options, progress);
  if (!fit.ok()) return fit;
  fit.no_noise = EstimateNoise(recordings, fit.Best().to, &fit.options);
  if (options.ensemble > 1) fit.others = FitOtherSeeds(recordings, trained.value());
  return fit;
}

void TakeSolution(const Solution& solution, FitResult* result) {
  result->starts = solution.starts;
  result->best_start = solution.best;
  result->solve_seconds = solution.seconds;
  if (!result->ok()) {
    result->message = "no start could be solved: " + solution.starts[0].message;
    return;
  }
  result->converged = solution.Best().converged;
  result->cost = solution.Best().cost;
  result->message = solution.Best().message;
}

// One that compares models; the printed formula of transitions does not.
bool ScoresSingleSteps(Likelihood likelihood) {
  return likelihood == Likelihood::kTransition || likelihood == Likelihood::kInnovation;
}

// What learned forces do of the work of physical ones.
void AddTakeover(const std::vector<PendulumRecording>& recordings, const ModelOptions& fitted,
                 FitResult* result) {
  if (fitted.learned && fitted.learned->shape.any()) {
    result->takeover = TakeoverOf(recordings, fitted);
  }
  if (fitted.interaction.LearnedBesideContact()) {
    result->contact_takeover = ContactTakeoverOf(recordings, fitted, result->parameters);
  }
}

// What predictions need to know of the recordings.
void AddFittedTo(const std::vector<PendulumRecording>& recordings, FitResult* result) {
  if (const PushedFeet feet = FeetOf(recordings); feet.seen > 0) result->feet = feet;
  result->push_range = FittedPushRange(ModelOf(*result), recordings);
  const auto steps = FitStepProbability(ModelOf(*result), recordings);
  if (steps && steps->stepped > 0 && steps->stepped < steps->tracks) {
    result->step_probability = steps;
  }
  result->recording_effect =
      FitRecordingEffect(ModelOf(*result), recordings, result->options.num_threads);
}

void AddWarnings(const FitProblem& problem, const SolvedFit& fit, FitResult* result) {
  std::vector<std::string>& warnings = result->warnings;
  warnings = FitWarnings(problem, *result);
  if (!fit.no_noise.empty()) warnings.push_back(fit.no_noise);
  if (fit.solved.weights_settled) return;
  warnings.push_back(
      fit.options.likelihood == Likelihood::kTrajectory
          ? "the weight of the data still changed by more than 1 % in the last round of "
            "reweighting: priors may have too much or too little weight"
          : "the likelihood still increased in the last round of solving");
}

// The covariance of a network's weights has no meaning for a reader and fills files: from here on
// the covariance is that of everything else, whatever the weights are. Bands draw from it with the
// weights as they are fitted, and so may be too wide where a network trades with a gain.
void ForgetWeights(Eigen::Index weights, FitResult* result) {
  if (weights == 0) return;
  Uncertainty& u = result->uncertainty;
  const Eigen::Index size = u.covariance.rows() - weights;
  u.covariance = u.covariance.topLeftCorner(size, size).eval();
  u.correlation = u.correlation.topLeftCorner(size, size).eval();
  u.estimates.resize(size);
  result->nuisance.resize(result->nuisance.size() - weights);
}

}  // namespace

FitResult Fit(const std::vector<PendulumRecording>& recordings, const FitOptions& options,
              const SolveProgress& progress) {
  FitResult result;
  result.options = options;

  // 1. Solve: parameters, the weight of the data and the spread of units in turn, and whether
  //    people must be held to settle (weighted_solve.h).
  const Result<SolvedFit> made = SolveFit(recordings, options, progress);
  if (!made.ok()) {
    result.message = made.error().ToString();
    return result;
  }
  const SolvedFit& fit = made.value();
  result.options = fit.options;
  TakeSolution(fit.solved.solution, &result);
  if (!result.ok()) return result;

  // 2. The parameters as they act, at the optimum of the problem as it was weighed last.
  const FitProblem problem(recordings, result.options);
  const FitPoint& optimum = fit.Best().to;
  result.options.model = problem.ModelAt(optimum);
  result.parameters = problem.Parameters(optimum, "");
  result.others = fit.others;
  AddTakeover(recordings, result.options.model, &result);

  // 3. Errors clustered by person, and the shares of data and priors (uncertainty.h).
  const std::optional<FitPoint>& free = fit.solved.free;
  result.uncertainty = ComputeUncertainty(problem, optimum, free ? &*free : nullptr);
  result.uncertainty.settling = fit.solved.settling;

  // 4. Tables: parameters, what ties units together, combinations, values of every unit.
  result.estimates = TableOfEstimates(problem, result.parameters, result.uncertainty);
  result.nuisance.assign(result.uncertainty.estimates.begin() + problem.map().num_shared(),
                         result.uncertainty.estimates.end());
  result.derived = TableOfCombinations(problem, optimum, result.uncertainty);
  AddUnits(problem, optimum, &result);

  // 5. The recordings that it was fitted to: their pushes, steps and effects.
  AddFittedTo(recordings, &result);

  // 6. Residuals: what the model leaves unexplained, recording by recording.
  result.diagnostics = Diagnose(problem, fit.Best(), result.uncertainty);
  result.recordings = FittedRecordings(problem, fit.Best());

  // 7. Behaviour: what the fitted people do after a push, and how likely single steps are.
  result.behaviour = problem.BehaviourAt(optimum);
  if (ScoresSingleSteps(options.likelihood))
    result.likelihood = ScoreByLikelihood(problem, optimum);

  // 8. Warnings; and what a model keeps of its covariance.
  AddWarnings(problem, fit, &result);
  ForgetWeights(static_cast<Eigen::Index>(optimum.weights.size()), &result);
  return result;
}

Result<IdentifiedModel> SolveModel(const std::vector<PendulumRecording>& recordings,
                                   FitOptions options) {
  if (MaybeError error = PrepareFit(recordings, &options)) return *error;
  const Result<SolvedFit> made = SolveFit(recordings, options, nullptr);
  if (!made.ok()) return made.error();
  const SolvedFit& fit = made.value();
  if (!fit.ok()) return Error{"no usable optimum was found"};
  const FitProblem problem(recordings, fit.options);
  const FitPoint& optimum = fit.Best().to;
  IdentifiedModel model;
  model.options = problem.ModelAt(optimum);
  model.mapping = fit.options.mapping;
  model.table = fit.options.table;
  model.parameters = problem.Parameters(optimum, "");
  model.others = fit.others;
  model.pool_by = fit.options.pool_by;
  for (const auto& [unit, deviations] : optimum.unit) {
    model.by_unit[unit] = problem.Parameters(optimum, unit);
  }
  model.step_probability = FitStepProbability(model, recordings);
  model.behaviour = problem.BehaviourAt(optimum);
  return model;
}

}  // namespace pushid
