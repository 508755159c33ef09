// ident: rows of a fit's tables.
#include "ident/fit/estimates_table.h"

#include <algorithm>
#include <limits>

#include "models/self_terms.h"

namespace pushid {
namespace {

std::string Describe(const RolloutStatus& status) {
  return std::string(status.quantity) + " of person " + std::to_string(status.person) +
         " leaves the model's domain at frame " + std::to_string(status.frame);
}

std::map<std::string, Estimate>& PooledOf(const std::string& unit, const FitProblem& problem,
                                          FitResult* result) {
  const bool settings = HoldsForRecording(problem.options().pool_by);
  return settings ? result->settings[unit] : result->subjects[unit].pooled;
}

// Of the sum of estimates a and b, which are a shared value and a deviation from it.
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
    const bool acts = Acts(spec.id, options.model) && !spec.tied_to && (!zero || convention);
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

std::vector<Combination> TableOfCombinations(const FitProblem& problem, const FitPoint& point,
                                             const Uncertainty& u) {
  std::vector<Combination> derived;
  const ParameterTable& table = problem.options().table;
  const auto tied = [&table](const Term& term) {
    return table[term.parameter].tied_to.has_value();
  };
  const auto not_its_own = [&](const Term& term) { return tied(term) || term.parameter == kMu; };
  for (const CombinationSpec& spec : DerivedCombinations(problem.options().model)) {
    // As another one is.
    if (std::any_of(spec.terms.begin(), spec.terms.end(), tied) &&
        std::all_of(spec.terms.begin(), spec.terms.end(), not_its_own)) {
      continue;
    }
    derived.push_back(Combine(problem, point, u, spec));
  }
  return derived;
}

void AddUnits(const FitProblem& problem, const FitPoint& point, FitResult* result) {
  for (const PendulumRecording& recording : problem.recordings()) {
    for (int n = 0; n < recording.num_people(); ++n) {
      result->subjects[recording.subject_ids[n]].mass_kg = recording.scene.people[n].body.mass;
    }
  }
  for (const auto& [unit, deviations] : point.unit) {
    const ParameterSet<double> values = problem.Parameters(point, unit);
    std::map<std::string, Estimate>& pooled = PooledOf(unit, problem, result);
    for (const FittedParameter& f : problem.map().fitted) {
      if (f.deviation < 0) continue;
      const ParameterSpec& spec = problem.options().table[f.parameter];
      Estimate& e = pooled[spec.name];
      e.name = spec.name;
      e.unit = spec.unit;
      e.value = values[spec.id];
    }
  }
}

void AddUnitErrors(const FitProblem& problem, const FitPoint& point, FitResult* result) {
  const auto& fitted = problem.map().fitted;
  int first = static_cast<int>(point.shared.size());
  for (const auto& [unit, deviations] : point.unit) {
    std::map<std::string, Estimate>& pooled = PooledOf(unit, problem, result);
    for (size_t i = 0; i < fitted.size(); ++i) {
      if (fitted[i].deviation < 0) continue;
      const ParameterSpec& spec = problem.options().table[fitted[i].parameter];
      AddErrors(result->uncertainty, static_cast<int>(i), first + fitted[i].deviation, spec,
                &pooled[spec.name]);
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
    fitted[failed.recording].failure = Describe(failed.status);
  }
  return fitted;
}

}  // namespace pushid
