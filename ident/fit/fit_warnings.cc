// ident: warnings of a fit, in words.
#include <algorithm>
#include <cmath>
#include <map>

#include "datasets/files/number_text.h"
#include "ident/fit/estimates_table.h"
#include "ident/problem/behaviour_text.h"
#include "ident/problem/fit_problem.h"
#include "ident/uncertainty/clusters.h"

namespace pushid {
namespace {

constexpr double kSameMass = 1.05;     // ratio of the masses of one person
constexpr double kPullToTell = 0.5;    // standard errors
constexpr double kHeldByDemand = 0.9;  // share of what determines a parameter

void AddVerdict(const FitResult& result, Warnings* warnings) {
  const ModelOptions& model = result.options.model;
  const Verdict verdict = VerdictOf(result.behaviour, model);
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
    warnings->emplace_back("the independent units are " + std::to_string(u.num_clusters) + " " +
                           many + ", fewer than ten: the standard errors are themselves uncertain");
  }
}

// An id is one person (clusters.h), who weighs nearly the same in all recordings.
void AddMassWarnings(const std::vector<PendulumRecording>& recordings, Warnings* warnings) {
  std::map<std::string, std::pair<double, double>> masses;  // least and largest, kg
  for (const PendulumRecording& recording : recordings) {
    for (int n = 0; n < recording.num_people(); ++n) {
      const double mass = recording.scene.people[n].body.mass;
      auto& [least, largest] =
          masses.emplace(recording.subject_ids[n], std::pair(mass, mass)).first->second;
      least = std::min(least, mass);
      largest = std::max(largest, mass);
    }
  }
  for (const auto& [id, range] : masses) {
    const auto& [least, largest] = range;
    if (largest <= kSameMass * least) continue;
    warnings->emplace_back(id + " weighs " + Rounded(least, 3) + " to " + Rounded(largest, 3) +
                           " kg: one id is one person; give different people different ids, or "
                           "correct the masses");
  }
}

// What the demand to settle did, if anything.
void AddSettlingWarning(const Uncertainty& u, const ModelOptions& model, size_t shared,
                        Warnings* warnings) {
  const SettlingDemand& s = u.settling;
  if (!s.binds) return;
  const std::string wanted =
      "without the settling constraint the model " +
      (std::isfinite(s.free_seconds) ? "settles after " + Rounded(s.free_seconds, 2) + " s"
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
  std::string moved, held;
  for (size_t i = 0; i < shared; ++i) {
    const Estimate& e = u.estimates[i];
    const double pull = e.standard_error > 0.0 ? e.shares.settling_pull / e.standard_error : 0.0;
    if (std::abs(pull) < kPullToTell || !std::isfinite(pull)) continue;
    if (e.shares.settling > kHeldByDemand) {  // its error says nothing of the data
      held += (held.empty() ? "" : ", ") + e.name;
      continue;
    }
    moved +=
        (moved.empty() ? "" : ", ") + e.name + " by " + (pull > 0.0 ? "+" : "") + Rounded(pull, 2);
  }
  std::string what = moved.empty() ? "" : moved + " standard errors";
  if (!held.empty()) {
    what += (what.empty() ? "" : ", and ") + held + " to where nothing else holds it";
  }
  if (what.empty()) what = "no parameter by half a standard error";
  warnings->emplace_back(wanted + "; the constraint to settle within " + WaitText(model) +
                         " moved " + what);
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
  AddMassWarnings(problem.recordings(), &warnings);
  AddClusterWarning(result.uncertainty, &warnings);
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
  return warnings;
}

}  // namespace pushid
