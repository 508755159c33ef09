// ident: parameters, and combinations of those that move.
#include "ident/uncertainty/profile_plan.h"

#include <algorithm>
#include <cmath>

#include "ident/problem/fit_problem.h"

namespace pushid {
namespace {

ProfileTarget CombinationTarget(const FitProblem& problem, const CombinationSpec& spec) {
  const ParameterMap& map = problem.map();
  ProfileTarget target{spec.name, spec.unit};
  target.coefficients.assign(map.fitted.size(), 0.0);
  for (const Term& term : spec.terms) {
    const auto at =
        std::find_if(map.fitted.begin(), map.fitted.end(),
                     [&term](const FittedParameter& f) { return f.parameter == term.parameter; });
    if (at == map.fitted.end()) {
      target.constant += term.coefficient * map.values[term.parameter];
    } else {
      target.coefficients[static_cast<size_t>(at - map.fitted.begin())] += term.coefficient;
    }
  }
  return target;
}

}  // namespace

ProfilePlan::ProfilePlan(const FitProblem& problem) {
  const auto& fitted = problem.map().fitted;
  for (size_t i = 0; i < fitted.size(); ++i) {
    const ParameterSpec& spec = problem.options().table[fitted[i].parameter];
    targets_.push_back({spec.name, spec.unit, spec.transform, static_cast<int>(i)});
    all_.push_back({spec.name, spec.unit, i});
  }
  for (const CombinationSpec& spec : DerivedCombinations(problem.options().model)) {
    Add(CombinationTarget(problem, spec));
  }
}

MaybeError ProfilePlan::Choose(const std::vector<std::string>& names) {
  std::string known;
  for (const ReportedProfile& r : all_) known += (known.empty() ? "" : ", ") + r.name;
  for (const std::string& name : names) {
    const auto at = std::find_if(all_.begin(), all_.end(),
                                 [&name](const ReportedProfile& r) { return r.name == name; });
    if (at == all_.end()) {
      return Error{"there is no profile of '" + name + "'; free numbers are " + known};
    }
    chosen_.push_back(*at);
  }
  if (names.empty()) chosen_ = all_;
  return std::nullopt;
}

Profile ProfilePlan::Reported(const ReportedProfile& reported, Profile profile) const {
  const Transform transform = targets_[reported.target].transform;
  const auto natural = [&](double value) {
    if (!std::isfinite(value)) return reported.factor * value;
    return reported.factor * ToNatural(transform, value) + reported.offset;
  };
  profile.name = reported.name;
  profile.unit = reported.unit;
  profile.estimate = natural(profile.estimate);
  profile.lower95 = natural(profile.lower95);
  profile.upper95 = natural(profile.upper95);
  for (ProfilePoint& point : profile.points) point.value = natural(point.value);
  return profile;
}

void ProfilePlan::Add(const ProfileTarget& combination) {
  const auto& c = combination.coefficients;
  const auto moves = [](double coefficient) { return coefficient != 0.0; };
  const auto first = std::find_if(c.begin(), c.end(), moves);
  if (first == c.end()) return;
  if (std::count_if(c.begin(), c.end(), moves) == 1) {
    all_.push_back({combination.name, combination.unit, static_cast<size_t>(first - c.begin()),
                    *first, combination.constant});
    return;
  }
  all_.push_back({combination.name, combination.unit, targets_.size()});
  targets_.push_back(combination);
}

}  // namespace pushid
