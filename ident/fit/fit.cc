// ident: a whole fit, from recordings to a judged result.
#include "ident/fit/fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "datasets/files/number_text.h"
#include "ident/fit/push_range.h"
#include "ident/fit/recording_effect.h"
#include "ident/fit/step_probability.h"
#include "ident/fit/weighted_solve.h"
#include "ident/problem/behaviour_text.h"
#include "ident/solver/likelihood_solve.h"
#include "ident/uncertainty/few_clusters.h"
#include "models/self_terms.h"
#include "residuals/takeover.h"

namespace pushid {
namespace {

constexpr double kPullToTell = 0.5;  // standard errors

std::string Describe(const RolloutStatus& status) {
  return std::string(status.quantity) + " of person " + std::to_string(status.person) +
         " leaves the model's domain at frame " + std::to_string(status.frame);
}

// Rows of the table: every free parameter, and every fixed one that acts.
std::vector<Estimate> TableOfEstimates(const FitProblem& problem,
                                       const ParameterSet<double>& values,
                                       const Uncertainty& uncertainty) {
  std::vector<Estimate> rows;
  const FitOptions& options = problem.options();
  for (const ParameterSpec& spec : options.table.specs) {
    const auto& fitted = problem.map().fitted;
    const auto at = std::find_if(fitted.begin(), fitted.end(), [&spec](const FittedParameter& f) {
      return f.parameter == spec.id;
    });
    if (at != fitted.end()) {
      rows.push_back(uncertainty.estimates[static_cast<size_t>(at - fitted.begin())]);
      continue;
    }
    // Self-force terms that are zero are left out too, but for the convention of mu and Kp.
    const bool convention = HeldByConvention(spec.id);
    const bool zero = spec.id < kTailGain && values[spec.id] == 0.0;
    const bool acts = Acts(spec.id, options.model) && (!zero || convention);
    if (!acts) continue;
    Estimate fixed;
    fixed.name = spec.name;
    fixed.unit = spec.unit;
    fixed.value = fixed.lower95 = fixed.upper95 = values[spec.id];
    fixed.status = EstimateStatus::kFixed;
    rows.push_back(fixed);
  }
  return rows;
}

std::vector<Combination> Derived(const FitProblem& problem, const FitPoint& point,
                                 const Uncertainty& u) {
  std::vector<Combination> derived;
  for (const CombinationSpec& spec : DerivedCombinations(problem.options().model)) {
    derived.push_back(Combine(problem, point, u, spec));
  }
  return derived;
}

// The pooled parameters of every unit: shared value and deviation together.
std::map<std::string, std::map<std::string, Estimate>> PooledByUnit(const FitProblem& problem,
                                                                    const FitPoint& point,
                                                                    const Uncertainty& u) {
  std::map<std::string, std::map<std::string, Estimate>> pooled;
  const auto& fitted = problem.map().fitted;
  int first = static_cast<int>(point.shared.size());
  for (const auto& [unit, deviations] : point.unit) {
    const ParameterSet<double> values = problem.Parameters(point, unit);
    for (size_t i = 0; i < fitted.size(); ++i) {
      if (fitted[i].deviation < 0) continue;
      const ParameterSpec& spec = problem.options().table[fitted[i].parameter];
      const int a = static_cast<int>(i), b = first + fitted[i].deviation;
      const double variance = u.covariance(a, a) + u.covariance(b, b) + 2.0 * u.covariance(a, b);
      const double error = std::sqrt(std::max(0.0, variance));
      Estimate e;
      e.freedom = std::min(u.estimates[i].freedom, u.estimates[b].freedom);
      e.standard_error_naive = std::numeric_limits<double>::quiet_NaN();  // not computed for sums
      // No better known than the shared value and its own deviation.
      const Estimate& worse =
          u.estimates[i].shares.data < u.estimates[b].shares.data ? u.estimates[i] : u.estimates[b];
      e.status = std::max(u.estimates[i].status, u.estimates[b].status);
      e.shares = worse.shares;
      e.shares.prior_pull = e.shares.settling_pull = 0.0;
      const double quantile = StudentQuantile95(e.freedom);
      e.name = spec.name;
      e.unit = spec.unit;
      e.value = values[spec.id];
      const double center = ToFitted(spec.transform, e.value);
      e.standard_error = error * TransformSlope(spec.transform, e.value);
      e.lower95 = ToNatural(spec.transform, center - quantile * error);
      e.upper95 = ToNatural(spec.transform, center + quantile * error);
      pooled[unit][spec.name] = e;
    }
    first += static_cast<int>(deviations.size());
  }
  return pooled;
}

void AddUnits(const FitProblem& problem, const FitPoint& point, FitResult* result) {
  for (const PendulumRecording& recording : problem.recordings()) {
    for (int n = 0; n < recording.num_people(); ++n) {
      result->subjects[recording.subject_ids[n]].mass_kg = recording.scene.people[n].body.mass;
    }
  }
  const auto pooled = PooledByUnit(problem, point, result->uncertainty);
  if (HoldsForRecording(problem.options().pool_by)) {
    result->settings = pooled;
  } else {
    for (const auto& [unit, estimates] : pooled) result->subjects[unit].pooled = estimates;
  }
}

std::vector<FittedRecording> FittedRecordings(const FitProblem& problem, const SolveStart& best) {
  std::vector<FittedRecording> fitted;
  for (const PendulumRecording& recording : problem.recordings()) {
    FittedRecording one;
    one.id = recording.id;
    one.content_hash = recording.content_hash;
    one.frames = recording.num_frames();
    one.people = recording.num_people();
    fitted.push_back(one);
  }
  for (const FailedRollout& failed : best.failed) {
    fitted[failed.recording].failure = Describe(failed.status);
  }
  FitPoint copy = best.to;
  const FitProblem::Built built = problem.Build(&copy, 0);
  for (const FitProblem::Built::Block& block : built.blocks) {
    if (block.cluster < 0) continue;
    double cost = 0.0;
    built.problem->EvaluateResidualBlock(block.id, false, &cost, nullptr, nullptr);
    fitted[block.cluster].cost = cost - built.OffsetOf(block.cluster);
  }
  return fitted;
}

void AddVerdict(const FitResult& result, std::vector<std::string>* warnings) {
  const ModelOptions& model = result.options.model;
  const Verdict verdict = VerdictOf(result.behaviour, model);
  if (verdict == Verdict::kSettles) return;
  const bool slow = verdict == Verdict::kSlowToSettle;
  // Holding it harder was tried, and dropped.
  const bool tried = slow && result.uncertainty.settling.dropped();
  warnings->push_back(
      VerdictName(verdict) + ": " + VerdictSentence(verdict, result.behaviour) +
      (slow ? "" : "; such a fit may score well but cannot be trusted beyond the data") +
      (tried ? "" : " (" + VerdictRemedy(verdict, model) + ")"));
}

void AddClusterWarning(const Uncertainty& u, std::vector<std::string>* warnings) {
  const std::string unit = u.clustered_by == ClusterBy::kSubject ? "person" : "recording";
  if (!u.clustered) {
    warnings->push_back("a single " + unit + ": errors cannot be clustered and are too small");
  } else if (u.num_clusters < kFewClusters) {
    const std::string many = unit == "person" ? "people" : "recordings";
    warnings->push_back("the independent units are " + std::to_string(u.num_clusters) + " " + many +
                        ", fewer than ten: the standard errors are themselves uncertain");
  }
}

// What the demand to settle did, if anything.
void AddSettlingWarning(const Uncertainty& u, size_t shared, std::vector<std::string>* warnings) {
  const SettlingDemand& s = u.settling;
  if (!s.binds) return;
  const std::string wanted =
      "without the settling constraint the model " +
      (std::isfinite(s.free_seconds) ? "settles after " + Rounded(s.free_seconds, 2) + " s"
                                     : std::string("does not settle within 10 s"));
  if (s.unmet) {
    warnings->push_back(wanted + ", and no fit that settles within " + Rounded(kWaitSeconds, 2) +
                        " s was found: the constraint was dropped");
    return;
  }
  if (s.contradicted) {
    warnings->push_back(wanted + "; settling within " + Rounded(kWaitSeconds, 2) +
                        " s contradicts the data (twice the log likelihood would fall by " +
                        Rounded(s.rise, 2) + "), and the constraint was dropped");
    return;
  }
  std::string moved;
  for (size_t i = 0; i < shared; ++i) {
    const Estimate& e = u.estimates[i];
    const double pull = e.standard_error > 0.0 ? e.shares.settling_pull / e.standard_error : 0.0;
    if (std::abs(pull) < kPullToTell || !std::isfinite(pull)) continue;
    moved +=
        (moved.empty() ? "" : ", ") + e.name + " by " + (pull > 0.0 ? "+" : "") + Rounded(pull, 2);
  }
  warnings->push_back(
      wanted + "; the constraint to settle within " + Rounded(kWaitSeconds, 2) + " s moved " +
      (moved.empty() ? "no parameter by half a standard error" : moved + " standard errors"));
}

std::vector<std::string> Warnings(const FitProblem& problem, const FitResult& result) {
  std::vector<std::string> warnings;
  for (const FittedRecording& recording : result.recordings) {
    if (!recording.failure.empty()) {
      warnings.push_back("recording " + recording.id + ": " + recording.failure +
                         "; only the frames before it were fitted");
    }
  }
  if (!result.converged) warnings.push_back("the solver stopped before it converged");
  AddVerdict(result, &warnings);
  if (const SettlingSimulation* d = result.behaviour.FarthestBehind()) {
    warnings.push_back("pushed forwards by " + Rounded(d->impulse, 4) + " N s, the pushed person" +
                       (d->people > 1 ? " of the line" : "") + " ends " +
                       Rounded(-d->pushed_advance, 2) + " m behind the start (" +
                       SettlingSimulationName(*d, SettingsDiffer(result.behaviour)) + ")");
  }
  AddClusterWarning(result.uncertainty, &warnings);
  AddSettlingWarning(result.uncertainty, problem.map().fitted.size(), &warnings);
  for (const Estimate& e : result.estimates) {
    if (e.status == EstimateStatus::kAtBound) warnings.push_back(e.name + " is at its bound");
  }
  const bool has_tail = problem.options().model.push_tail != PushTail::kNone;
  if (has_tail && TailCannotAct(problem.recordings())) {
    warnings.push_back(
        "every push is external (measured completely): the push tail has no effect; set push_kind "
        "to net in the manifest for pushes that were measured only in part");
  }
  return warnings;
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
  if (NeedsGradientTraining(options)) {
    const Result<FitOptions> trained = WithLargeNetworkTrained(recordings, options, progress);
    if (trained.ok()) return Fit(recordings, trained.value(), progress);
    result.message = trained.error().ToString();
    return result;
  }
  const bool rollouts = options.likelihood == Likelihood::kTrajectory;
  const WeightedSolution solved = SolveAsAsked(recordings, &result.options, progress);
  const Solution& solution = solved.solution;
  std::string no_noise;
  if (solution.best >= 0) {
    no_noise = EstimateNoise(recordings, solution.Best().to, &result.options);
  }
  const FitProblem problem(recordings, result.options);
  result.starts = solution.starts;
  result.best_start = solution.best;
  result.solve_seconds = solution.seconds;
  if (!result.ok()) {
    result.message = "no start could be solved: " + solution.starts[0].message;
    return result;
  }
  const SolveStart& best = solution.Best();
  result.converged = best.converged;
  result.cost = best.cost;
  result.message = best.message;
  result.parameters = problem.Parameters(best.to, "");
  const ModelOptions fitted = problem.ModelAt(best.to);
  if (fitted.learned && fitted.learned->shape.any()) {
    result.takeover = TakeoverOf(recordings, fitted);
  }
  if (fitted.interaction.LearnedBesideContact()) {
    result.contact_takeover = ContactTakeoverOf(recordings, fitted, result.parameters);
  }
  if (options.ensemble > 1) result.others = FitOtherSeeds(recordings, options);
  result.uncertainty = ComputeUncertainty(problem, best.to, solved.free ? &*solved.free : nullptr);
  result.uncertainty.settling = solved.settling;
  result.estimates = TableOfEstimates(problem, result.parameters, result.uncertainty);
  result.nuisance.assign(result.uncertainty.estimates.begin() + problem.map().num_shared(),
                         result.uncertainty.estimates.end());
  result.derived = Derived(problem, best.to, result.uncertainty);
  AddUnits(problem, best.to, &result);
  result.push_range = FittedPushRange(ModelOf(result), recordings);
  const auto steps = FitStepProbability(ModelOf(result), recordings);
  if (steps && steps->stepped > 0 && steps->stepped < steps->tracks) {
    result.step_probability = steps;
  }
  result.recording_effect = FitRecordingEffect(ModelOf(result), recordings, options.num_threads);
  result.diagnostics = Diagnose(problem, best, result.uncertainty);
  result.behaviour = problem.BehaviourAt(best.to);
  result.recordings = FittedRecordings(problem, best);
  result.warnings = Warnings(problem, result);
  if (!no_noise.empty()) result.warnings.push_back(no_noise);
  if (!rollouts && options.likelihood != Likelihood::kTransitionAsPrinted) {
    result.likelihood = ScoreByLikelihood(problem, best.to);
  }
  if (!solved.weights_settled && !rollouts) {
    result.warnings.push_back("the likelihood still increased in the last round of solving");
  }
  if (!solved.weights_settled && rollouts) {
    result.warnings.push_back(
        "the weight of the data still changed by more than 1 % in the last round of reweighting: "
        "priors may have too much or too little weight");
  }
  result.options.model = problem.ModelAt(best.to);
  ForgetWeights(static_cast<Eigen::Index>(best.to.weights.size()), &result);
  return result;
}

}  // namespace pushid
