// ident: rows of a fit's tables.
#include "ident/fit/estimates_table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "datasets/inspection/inspection.h"
#include "ident/model/model_rollout.h"
#include "ident/problem/behaviour.h"
#include "ident/uncertainty/covariance.h"
#include "models/self_terms.h"

namespace pushid {
namespace {

// Errors of the sum of estimates a and b, a shared value and a deviation from it.
void AddErrors(const Uncertainty& u, int a, int b, const ParameterSpec& spec, Estimate* sum) {
  const Estimate &shared = u.estimates[a], &deviation = u.estimates[b];
  const Eigen::Index size = u.covariance.rows();
  const ScatterOf of =
      u.scatter.Of(Eigen::VectorXd::Unit(size, a) + Eigen::VectorXd::Unit(size, b));
  sum->freedom = of.freedom;
  sum->quantile = of.quantile;
  sum->standard_error_naive = std::numeric_limits<double>::quiet_NaN();  // not computed for sums
  // No better known than the shared value and its own deviation.
  sum->status = std::max(shared.status, deviation.status);
  sum->shares = shared.shares.data < deviation.shares.data ? shared.shares : deviation.shares;
  sum->shares.prior_pull = sum->shares.settling_pull = 0.0;
  const double center = ToFitted(spec.transform, sum->value);
  sum->standard_error = of.standard_error * TransformSlope(spec.transform, sum->value);
  sum->lower95 = ToNatural(spec.transform, center - of.HalfWidth());
  sum->upper95 = ToNatural(spec.transform, center + of.HalfWidth());
}

}  // namespace

std::vector<Estimate> TableOfEstimates(const FitProblem& problem,
                                       const ParameterSet<double>& values,
                                       const Uncertainty& uncertainty) {
  std::vector<Estimate> rows;
  const FitOptions& options = problem.options();
  for (const ParameterSpec& spec : options.table.specs) {
    const size_t at = problem.FittedIndex(spec.id);
    if (at < problem.map().fitted.size()) {
      rows.push_back(uncertainty.estimates[at]);
      continue;
    }
    // Self-force terms that are zero are left out too, but for the convention of mu and Kp.
    const bool zero = spec.id < kTailGain && values[spec.id] == 0.0;
    if (!Acts(spec.id, options.model) || spec.tied_to) continue;
    if (zero && !HeldByConvention(spec.id)) continue;
    Estimate fixed;
    fixed.name = spec.name;
    fixed.unit = spec.unit;
    fixed.value = fixed.lower95 = fixed.upper95 = values[spec.id];
    fixed.status = EstimateStatus::kFixed;
    rows.push_back(fixed);
  }
  return rows;
}

std::vector<Combination> TableOfCombinations(const FitProblem& problem, const FitPoint& point,
                                             const Uncertainty& u) {
  std::vector<Combination> derived;
  const ParameterTable& table = problem.options().table;
  const auto tied = [&table](const Term& term) {
    return table[term.parameter].tied_to.has_value();
  };
  const auto not_its_own = [&](const Term& term) { return tied(term) || term.parameter == kMu; };
  for (const CombinationSpec& spec : DerivedCombinations(problem.options().model)) {
    // A combination of tied parameters alone says what another one says already.
    if (std::any_of(spec.terms.begin(), spec.terms.end(), tied) &&
        std::all_of(spec.terms.begin(), spec.terms.end(), not_its_own)) {
      continue;
    }
    derived.push_back(Combine(problem, point, u, spec));
  }
  return derived;
}

void AddUnits(const FitProblem& problem, const FitPoint& point, const Uncertainty* u,
              FitResult* result) {
  for (const PendulumRecording& recording : problem.recordings()) {
    for (int n = 0; n < recording.num_people(); ++n) {
      result->subjects[recording.subject_ids[n]].mass_kg = recording.scene.people[n].body.mass;
    }
  }
  const bool settings = HoldsForRecording(problem.options().pool_by);
  int first = static_cast<int>(point.shared.size());
  for (const auto& [unit, deviations] : point.unit) {
    const ParameterSet<double> values = problem.Parameters(point, unit);
    std::map<std::string, Estimate>& pooled =
        settings ? result->settings[unit] : result->subjects[unit].pooled;
    for (size_t i = 0; i < problem.map().fitted.size(); ++i) {
      const int deviation = problem.map().fitted[i].deviation;
      if (deviation < 0) continue;
      const ParameterSpec& spec = problem.Spec(i);
      Estimate& e = pooled[spec.name];
      e.name = spec.name;
      e.unit = spec.unit;
      e.value = values[spec.id];
      if (u != nullptr) AddErrors(*u, static_cast<int>(i), first + deviation, spec, &e);
    }
    first += static_cast<int>(deviations.size());
  }
}

std::vector<FittedRecording> FittedRecordings(const FitProblem& problem, const SolveStart& best,
                                              const Diagnostics& diagnostics) {
  std::vector<FittedRecording> fitted;
  for (const PendulumRecording& recording : problem.recordings()) {
    FittedRecording one;
    one.id = recording.id;
    one.content_hash = recording.content_hash;
    one.frames = recording.num_frames();
    one.people = recording.num_people();
    one.cost = diagnostics.recordings[fitted.size()].cost;
    fitted.push_back(one);
  }
  for (const FailedRollout& failed : best.failed) {
    fitted[failed.recording].failure = OutsideText(failed.status);
  }
  return fitted;
}

namespace {

constexpr double kPullToTell = 0.5;    // standard errors
constexpr double kHeldByDemand = 0.9;  // share of what determines a parameter

void AddVerdict(const FitResult& result, Warnings* warnings) {
  const ModelOptions& model = result.options.model;
  const Verdict verdict = VerdictOf(result.behaviour);
  if (verdict == Verdict::kSettles) return;
  const bool slow = verdict == Verdict::kSlowToSettle;
  // Holding it harder was tried, and dropped.
  const bool tried = slow && result.uncertainty.settling.dropped();
  warnings->emplace_back(
      VerdictName(verdict) + ": " + VerdictSentence(verdict, result.behaviour, model) +
      (slow ? "" : "; such a fit may score well but cannot be trusted beyond the data") +
      (tried ? "" : " (" + VerdictRemedy(verdict, model) + ")"));
}

void AddClusterWarning(const Uncertainty& u, Warnings* warnings) {
  const std::string unit = u.clustered_by == ClusterBy::kSubject ? "person" : "recording";
  if (!u.clustered) {
    warnings->emplace_back("a single " + unit +
                           ": errors between people are unknown, and nothing is identified");
  } else if (u.about_people_like_them && u.num_people < kFewestPeople) {
    warnings->emplace_back(
        std::to_string(u.num_people) +
        " people: nothing is identified about people like them; record at least " +
        std::to_string(kFewestPeople));
  } else if (u.num_clusters < kFewClusters) {
    const std::string many = unit == "person" ? "people" : "recordings";
    warnings->emplace_back(std::to_string(u.num_clusters) + " " + many +
                           ", fewer than ten: the standard errors are themselves uncertain");
  }
}

// Fewer line-ups do not tell how far others would differ.
constexpr size_t kFewLineUps = 4;

// Forces between people are seen of each line-up once, however often it was pushed.
void AddLineUpWarning(const FitProblem& problem, Warnings* warnings) {
  std::vector<std::string> names;
  for (Parameter id : problem.options().table.Free()) {
    if (IsPairParameter(id)) names.push_back(problem.options().table[id].name);
  }
  std::set<std::vector<std::string>> line_ups;
  for (const PendulumRecording& recording : problem.recordings()) {
    std::vector<std::string> people = recording.subject_ids;
    std::sort(people.begin(), people.end());
    if (people.size() > 1) line_ups.insert(people);
  }
  if (names.empty() || line_ups.empty() || line_ups.size() >= kFewLineUps) return;
  const std::string from =
      line_ups.size() == 1 ? "one line-up" : std::to_string(line_ups.size()) + " line-ups";
  warnings->emplace_back(
      Joined(names) + " come from " + from +
      " of people, fewer than four: how far others differ is not known; read the columns of these "
      "people");
}

// The effect of the demand to settle, if any.
void AddSettlingWarning(const Uncertainty& u, const ModelOptions& model, size_t shared,
                        Warnings* warnings) {
  const SettlingDemand& s = u.settling;
  if (!s.binds) return;
  const std::string wanted =
      "unconstrained, the model " + (std::isfinite(s.free_seconds)
                                         ? "settles after " + Rounded(s.free_seconds, 2) + " s"
                                         : std::string("does not settle within 10 s"));
  if (s.unmet) {
    warnings->emplace_back(wanted + ", and no fit that settles within " + WaitText(model) +
                           " was found: the constraint was dropped");
    return;
  }
  if (s.contradicted) {
    warnings->emplace_back(wanted + "; settling within " + WaitText(model) +
                           " contradicts the data (twice the log likelihood would fall by " +
                           Rounded(s.rise, 2) + "), and the constraint was dropped");
    return;
  }
  std::vector<std::string> moved, held;
  for (size_t i = 0; i < shared; ++i) {
    const Estimate& e = u.estimates[i];
    const double pull = e.standard_error > 0.0 ? e.shares.settling_pull / e.standard_error : 0.0;
    if (std::abs(pull) < kPullToTell || !std::isfinite(pull)) continue;
    if (e.shares.settling > kHeldByDemand) {  // its error says nothing of the data
      held.push_back(e.name);
    } else {
      moved.push_back(e.name + " by " + (pull > 0.0 ? "+" : "") + Rounded(pull, 2));
    }
  }
  std::vector<std::string> what;
  if (!moved.empty()) what.push_back(Joined(moved) + " standard errors");
  if (!held.empty()) what.push_back(Joined(held) + " to where nothing else holds it");
  if (what.empty()) what = {"no parameter by half a standard error"};
  warnings->emplace_back(wanted + "; the settling constraint (" + WaitText(model) + ") moved " +
                         Joined(what, ", and "));
}

}  // namespace

Warnings FitWarnings(const FitProblem& problem, const FitResult& result) {
  Warnings warnings;
  for (const FittedRecording& recording : result.recordings) {
    if (!recording.failure.empty()) {
      const std::string what = recording.failure + "; only the frames before it were fitted";
      warnings.emplace_back("recording " + recording.id + ": " + what, recording.id, what);
    }
  }
  const ModelOptions& model = problem.options().model;
  const std::string of_feet = FeetWarning(FeetOf(problem.recordings()), model.stance);
  if (!of_feet.empty()) warnings.emplace_back(of_feet);
  if (!result.converged) warnings.emplace_back("the solver stopped before it converged");
  AddVerdict(result, &warnings);
  if (const SettlingSimulation* d = result.behaviour.FarthestBehind()) {
    warnings.emplace_back("pushed forwards by " + Rounded(d->impulse, 4) +
                          " N s, the pushed person" + (d->people > 1 ? " of the line" : "") +
                          " ends " + Rounded(-d->pushed_advance, 2) + " m behind the start (" +
                          SettlingSimulationName(*d, SettingsDiffer(result.behaviour)) + ")");
  }
  for (std::string& text : MassTexts(problem.recordings())) warnings.emplace_back(std::move(text));
  AddSettlingWarning(result.uncertainty, model, problem.map().fitted.size(), &warnings);
  for (const Estimate& e : result.estimates) {
    if (e.status == EstimateStatus::kAtBound) warnings.emplace_back(e.name + " is at its bound");
  }
  const bool has_tail = model.push_tail != PushTail::kNone;
  if (has_tail && TailCannotAct(problem.recordings())) {
    warnings.emplace_back(
        "every push is external (measured completely): the push tail has no effect; set push_kind "
        "to net in the manifest for pushes that were measured only in part");
  }
  AddClusterWarning(result.uncertainty, &warnings);
  AddLineUpWarning(problem, &warnings);
  return warnings;
}

}  // namespace pushid
