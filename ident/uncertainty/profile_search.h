// ident: which numbers of a fit have a profile, which of them share one, and the search for its
// ends.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "ident/uncertainty/profile.h"
#include "ident/uncertainty/uncertainty.h"
#include "residuals/parameter_map.h"

namespace pushid {

class FitProblem;

// A number to be profiled: one fitted parameter on its fitted scale, or a combination of natural
// values.
struct ProfileTarget {
  std::string name, unit;
  Transform transform = Transform::kIdentity;
  int index = -1;                      // of the parameter; -1 for a combination
  std::vector<double> coefficients{};  // of a combination, by fitted parameter
  double constant = 0.0;               // what fixed parameters contribute
};

// A profile to report: a target's, or a linear function of it in natural values; factors are
// positive.
struct ReportedProfile {
  std::string name, unit;
  size_t target;
  double factor = 1.0, offset = 0.0;
};

// Everything that moves, or what is named; each target once.
class ProfilePlan {
 public:
  explicit ProfilePlan(const FitProblem& problem);

  // No names: all. Errors: a name of nothing that moves.
  MaybeError Choose(const std::vector<std::string>& names);

  const std::vector<ProfileTarget>& targets() const { return targets_; }
  const std::vector<ReportedProfile>& chosen() const { return chosen_; }
  // From its target's scale to natural values and its own name.
  Profile Reported(const ReportedProfile& reported, Profile of_target) const;

 private:
  void Add(const ProfileTarget& combination);

  std::vector<ProfileTarget> targets_;
  std::vector<ReportedProfile> all_, chosen_;
};

}  // namespace pushid
