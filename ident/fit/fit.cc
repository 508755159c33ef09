// ident: solving and weighing in turn.
#include "ident/fit/fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "datasets/files/number_text.h"
#include "datasets/files/numeric_table.h"
#include "ident/fit/covariates.h"
#include "ident/fit/estimates_table.h"
#include "ident/fit/step_probability.h"
#include "ident/model/model_rollout.h"
#include "ident/problem/behaviour.h"
#include "ident/problem/folds.h"
#include "ident/problem/statistics.h"
#include "ident/uncertainty/bootstrap.h"
#include "ident/uncertainty/covariance.h"
#include "ident/uncertainty/model_verdict.h"

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

// The weights of the problem's parts by what is known at a point, and the recordings' sums by these
// weights; returns the largest relative change.
double Reweigh(FitProblem problem, const FitPoint& point, FitOptions* weights,
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

// Intermediate optima need not be exact: a looser tolerance and fewer iterations for them.
FitProblem WithTolerance(FitProblem problem, double tolerance,
                         int iterations = std::numeric_limits<int>::max()) {
  FitOptions& options = *problem.mutable_options();
  options.function_tolerance = std::max(tolerance, options.function_tolerance);
  options.max_iterations = std::min(iterations, options.max_iterations);
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
  for (const SolveStage& stage : again.stages) start->Add(stage);
  start->to = std::move(again.to);
  start->recordings = std::move(again.recordings);
  start->message = std::move(again.message);
}

// Solves and estimates the weights in turns: with a rough tolerance until the weights settle, then
// exactly until they settle again. False where they do not.
bool SolveAndReweigh(FitProblem* problem, SolveStart* start) {
  const bool network = problem->options().model.learned != nullptr;
  bool exact = false;
  for (int round = 0; round < kMostRounds; ++round) {
    FitOptions now = problem->options();
    RecordingSums recordings;
    const bool settled = Reweigh(*problem, start->to, &now, &recordings) < kSettled;
    if (settled && exact) return true;
    exact = exact || settled;
    if (!settled) {
      problem->SetWeights(now);
      start->recordings = std::move(recordings);
    }
    const FitProblem rough = WithTolerance(
        *problem, kRough, network ? problem->options().max_iterations : kFewIterations);
    SolveOn(exact ? *problem : rough, start);
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
    part.mutable_options()->settling_weight = share * demanding.options().settling_weight;
    if (share == kDemandSteps[0] && std::isinf(CostAt(part.WithoutRecordings(), free.to))) {
      held = SolveFrom(WithTolerance(part, kRough), part.NominalPoint(), "nominal", nullptr);
    } else {
      const double exact = part.options().function_tolerance;
      SolveOn(WithTolerance(part, share < 1.0 ? kLessExact * exact : exact), &held);
    }
  }
  held.failed = FailuresAfter(demanding, held);
  return held;
}

// Step 2 of the header, from the optimum without the demand.
void Demand(double weight, FitProblem* problem, WeightedSolution* solved) {
  SolveStart& best = solved->solution.start;
  const FitProblem without = *problem;
  problem->mutable_options()->settling_weight = weight;
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
    problem->mutable_options()->settling_weight = 0.0;
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
  problem->mutable_options()->settling_weight = 0.0;
  WeightedSolution solved;
  Solution& solution = solved.solution;
  solution = Solve(WithTolerance(*problem, kRough), progress);
  solved.work.Add("starts and horizons");
  if (!solution.ok()) {
    problem->mutable_options()->settling_weight = weight;
    return solved;
  }
  SolveStart& best = solution.start;
  solution.settled = SolveAndReweigh(problem, &best);
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
  WeightedSolution solved;
  solved.solution = SolveByLikelihood(problem, progress);
  solved.work.Add("likelihood");
  return solved;
}

namespace {

// A solved problem, as it was weighed last.
struct SolvedFit {
  FitProblem problem;
  WeightedSolution solved;

  bool ok() const { return solved.solution.ok(); }
  const SolveStart& Best() const { return solved.solution.start; }
};

// Errors: a large network's training fails; without a usable optimum the result is not ok().
Result<SolvedFit> SetUpAndSolve(const std::vector<PendulumRecording>& recordings,
                                const FitOptions& options, const SolveProgress& progress) {
  const bool trains = NeedsGradientTraining(options);
  const Result<FitOptions> trained =
      trains ? TrainLargeNetwork(recordings, options, progress) : Result<FitOptions>(options);
  if (!trained.ok()) return trained.error();
  SolvedFit fit{FitProblem(recordings, trained.value()), {}};
  // What was trained together by given weights is an optimum of it all already.
  if (trains && !options.estimate_weights) {
    fit.problem.mutable_options()->gradient_tolerance = std::numeric_limits<double>::infinity();
  }
  fit.solved = SolveFit(&fit.problem, progress);
  fit.problem.mutable_options()->gradient_tolerance = options.gradient_tolerance;
  return fit;
}

// Before any judgement: the parameters as they act, and the fitted people's behaviour.
FitResult ResultOf(const SolvedFit& fit) {
  const Solution& solution = fit.solved.solution;
  FitResult result;
  result.options = fit.problem.options();
  result.starts = {solution.start};
  result.best_start = solution.ok() ? 0 : -1;
  result.solve_seconds = solution.seconds;
  if (!result.ok()) {
    result.message = "no start could be solved: " + solution.start.message;
    return result;
  }
  const SolveStart& best = solution.start;
  result.converged = best.converged;
  result.cost = best.cost;
  result.message = best.message;
  result.options.model = fit.problem.ModelAt(best.to);
  result.parameters = fit.problem.Parameters(best.to, "");
  result.behaviour = fit.problem.BehaviourAt(best.to);
  AddUnits(fit.problem, best.to, nullptr, &result);
  return result;
}

// The covariance of a network's weights has no meaning for a reader and fills files: from here on
// the covariance is that of everything else, whatever the weights are. Bands draw from it with the
// weights as they are fitted, and so may be too wide where a network trades with a gain.
void DropNetworkWeights(size_t weights, FitResult* result) {
  if (weights == 0) return;
  Uncertainty& u = result->uncertainty;
  const Eigen::Index size = u.covariance.rows() - static_cast<Eigen::Index>(weights);
  u.covariance = u.covariance.topLeftCorner(size, size).eval();
  u.correlation = u.correlation.topLeftCorner(size, size).eval();
  u.estimates.resize(size);
  result->nuisance.resize(result->nuisance.size() - weights);
}

FitResult Judge(const SolvedFit& fit) {
  FitResult result = ResultOf(fit);
  if (!result.ok()) return result;
  const FitProblem& problem = fit.problem;
  const FitPoint& optimum = fit.Best().to;
  const std::optional<FitPoint>& free = fit.solved.free;
  WorkLog work = fit.solved.work;

  // Errors clustered by person, and the shares of data and priors (uncertainty.h).
  result.uncertainty = ComputeUncertainty(problem, optimum, free ? &*free : nullptr);
  result.uncertainty.settling = fit.solved.settling;

  // The verdict: whether the model fits, what would change if what was taken as known were not,
  // and which estimates may be called identified (model_verdict.h).
  work.Add("standard errors");
  result.verdict = JudgeModel(problem, optimum, result.behaviour, &result.uncertainty);
  work.Add("verdict");

  // Tables: parameters, what ties units together, combinations, values of every unit.
  result.estimates = TableOfEstimates(problem, result.parameters, result.uncertainty);
  result.nuisance.assign(result.uncertainty.estimates.begin() + problem.map().num_shared(),
                         result.uncertainty.estimates.end());
  result.derived = TableOfCombinations(problem, optimum, result.uncertainty);
  AddUnits(problem, optimum, &result.uncertainty, &result);
  result.contrast = ContrastAt(problem, optimum, result.uncertainty);

  // The recordings that it was fitted to: their pushes and steps.
  work.Add("tables");
  const std::vector<PendulumRecording>& recordings = problem.recordings();
  if (const PushedFeet feet = FeetOf(recordings); feet.seen > 0) result.feet = feet;
  result.push_range = FittedPushRange(ModelOf(result), recordings);
  const auto steps = FitStepProbability(ModelOf(result), recordings);
  if (steps && steps->stepped > 0 && steps->stepped < steps->tracks) {
    result.step_probability = steps;
  }
  work.Add("steps");

  // Residuals: what the model leaves unexplained, recording by recording.
  result.diagnostics = Diagnose(problem, fit.Best(), result.uncertainty);
  result.recordings = FittedRecordings(problem, fit.Best(), result.diagnostics);
  if (result.options.likelihood != Likelihood::kTrajectory) {
    result.likelihood = ScoreByLikelihood(problem, optimum);
  }

  work.Add("diagnostics");

  // Warnings; and what a model keeps of its covariance.
  result.warnings = FitWarnings(problem, result);
  if (!fit.solved.solution.settled) {
    result.warnings.emplace_back(
        result.options.likelihood == Likelihood::kTrajectory
            ? "the weight of the data still changed by more than 1 % in the last round of "
              "reweighting: priors may have too much or too little weight"
            : "the likelihood still increased in the last round of solving");
  }
  result.work = work.parts();
  DropNetworkWeights(optimum.weights.size(), &result);
  return result;
}

constexpr size_t kFolds = 4, kFewestUnits = 3;
// Function tolerance: what a smaller one would change is little beside what people differ by.
constexpr double kFoldTolerance = 1e-5;

// Solved again from the optimum, without the recordings held out (indices), by the weights of
// residuals and the spreads of pooled units of the whole, or by those of the others alone. None
// without a usable optimum.
std::optional<IdentifiedModel> RefitWithout(const FitProblem& problem, const FitPoint& optimum,
                                            const IdentifiedModel& model,
                                            const std::vector<int>& held_out, bool by_own_weights) {
  FitOptions options = problem.options();
  options.num_threads = 1;
  options.function_tolerance = std::max(kFoldTolerance, options.function_tolerance);
  std::vector<int> counts(problem.recordings().size(), 1);
  for (int i : held_out) counts[i] = 0;
  FitProblem others(problem.recordings(), options, counts);
  SolveStart fit = Refit(others, optimum);
  if (by_own_weights && fit.usable) SolveAndReweigh(&others, &fit);
  if (!fit.usable) return std::nullopt;
  IdentifiedModel refitted = model;
  refitted.options = others.ModelAt(fit.to);
  refitted.parameters = others.Parameters(fit.to, "");
  for (auto& [unit, parameters] : refitted.by_unit) parameters = others.Parameters(fit.to, unit);
  refitted.push_range.reset();
  refitted.push_range = FittedPushRange(refitted, Without(problem.recordings(), held_out));
  return refitted;
}

}  // namespace

FitResult Fit(const std::vector<PendulumRecording>& recordings, const FitOptions& options,
              const SolveProgress& progress) {
  const Result<SolvedFit> fit = SetUpAndSolve(recordings, options, progress);
  if (fit.ok()) {
    FitResult result = Judge(fit.value());
    JudgeContrastByPeople(recordings, &result);
    return result;
  }
  FitResult none;
  none.options = options;
  none.message = fit.error().ToString();
  return none;
}

namespace {

// %, of the hip's motion in the median recording.
double Explained(const FitResult& result) {
  std::vector<double> explained;
  for (const RecordingDiagnostics& r : result.diagnostics.recordings) {
    if (r.moved) explained.push_back(r.explained);
  }
  if (!result.ok() || explained.empty()) return -INFINITY;
  return UpperMedian(std::move(explained));
}

}  // namespace

FitResult FitAnyStance(const std::vector<PendulumRecording>& recordings, const FitOptions& options,
                       const std::vector<FitOptions>& others, const SolveProgress& progress) {
  FitResult best = Fit(recordings, options, progress);
  if (!best.ok() || others.empty()) return best;
  // Unless standing still is the better prediction of half of them.
  const std::vector<RecordingDiagnostics>& all = best.diagnostics.recordings;
  const auto worse = std::count_if(all.begin(), all.end(), &WorseThanStatic);
  if (worse == 0 || 2 * worse < static_cast<std::ptrdiff_t>(all.size())) return best;
  const auto name = [](const FitResult& result) {
    return "--stance=" + NameOf(result.options.model.stance) + " explains " +
           Rounded(Explained(result), 3) + " %";
  };
  std::string tried = name(best);
  for (FitOptions other : others) {
    if (PrepareFit(recordings, &other)) continue;
    FitResult result = Fit(recordings, other, progress);
    if (!result.ok()) continue;
    tried += ", " + name(result);
    if (Explained(result) > Explained(best)) best = std::move(result);
  }
  best.warnings.insert(best.warnings.begin(),
                       {"of the hip's motion in the median recording " + tried +
                        "; this is the fit with --stance=" + NameOf(best.options.model.stance)});
  return best;
}

Result<FoldedModels> SolveFolds(const std::vector<PendulumRecording>& recordings,
                                FitOptions options, const std::vector<std::vector<int>>& held_out,
                                bool forecasts) {
  const FitOptions asked = options;
  if (MaybeError error = PrepareFit(recordings, &options)) return *error;
  const Result<SolvedFit> fit = SetUpAndSolve(recordings, options, nullptr);
  if (!fit.ok()) return fit.error();
  if (!fit.value().ok()) return Error{"no usable optimum was found"};
  const SolvedFit& solved = fit.value();
  const FitPoint& optimum = solved.Best().to;
  FoldedModels models{ModelOf(ResultOf(solved)), {}};
  IdentifiedModel& model = models.whole;
  model.push_range = FittedPushRange(model, recordings);
  model.step_probability = FitStepProbability(model, recordings);
  for (const std::vector<int>& fold : held_out) {
    if (options.model.learned == nullptr) {
      models.without.push_back(RefitWithout(solved.problem, optimum, model, fold, false));
      continue;
    }
    Result<IdentifiedModel> anew = SolveModel(Without(recordings, fold), asked);
    models.without.emplace_back();
    if (anew.ok()) models.without.back() = std::move(anew.value());
  }
  if (!forecasts) return models;
  model.forecasts = LearnForecasts(model, recordings,
                                   CrossFit(solved.problem, optimum, model, options.num_threads),
                                   options.num_threads);
  return models;
}

Result<IdentifiedModel> SolveModel(const std::vector<PendulumRecording>& recordings,
                                   FitOptions options, bool forecasts) {
  Result<FoldedModels> models = SolveFolds(recordings, std::move(options), {}, forecasts);
  if (!models.ok()) return models.error();
  return std::move(models.value().whole);
}

std::vector<FoldModel> CrossFit(const FitProblem& problem, const FitPoint& optimum,
                                const IdentifiedModel& model, int num_threads) {
  if (NeedsGradientTraining(problem.options())) return {};
  std::vector<std::vector<int>> units =
      MakeResamplingUnits(problem.recordings(), ClusterBy::kAuto).units;
  if (units.size() < kFewestUnits) {
    units.clear();
    for (size_t i = 0; i < problem.recordings().size(); ++i) units.push_back({static_cast<int>(i)});
  }
  if (units.size() < kFewestUnits) return {};
  std::vector<std::vector<int>> held_out(std::min(kFolds, units.size()));
  for (size_t u = 0; u < units.size(); ++u) {
    std::vector<int>& fold = held_out[u % held_out.size()];
    fold.insert(fold.end(), units[u].begin(), units[u].end());
  }
  std::vector<std::optional<FoldModel>> made(held_out.size());
  ParallelFor(static_cast<int>(held_out.size()), num_threads, [&](int f) {
    std::optional<IdentifiedModel> refitted =
        RefitWithout(problem, optimum, model, held_out[f], true);
    if (!refitted) return;
    made[f].emplace(FoldModel{*std::move(refitted), held_out[f]});
  });
  std::vector<FoldModel> folds;
  for (std::optional<FoldModel>& fold : made) {
    if (fold) folds.push_back(*std::move(fold));
  }
  return folds;
}

}  // namespace pushid
