// ident: the three kinds of intervals of a fit side by side.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ident/model/fitted_model.h"

namespace pushid {

// One number as clustered covariance, profile and bootstrap see it.
struct Agreement {
  std::string name, unit;
  double value = 0.0;
  double quantile =
      2.0;  // half-width over standard error, of the clustered interval and the profile
  Interval clustered;
  std::optional<Interval> profile, bootstrap;
  std::optional<ProfileClass> classification, by_data_alone;
  // Largest width over smallest, of those that are finite; infinite when only some are.
  double ratio = 1.0;
};

inline constexpr double kDisagreement = 1.5;  // a ratio from which on it is reported

// Every free parameter and moving combination that a profile or the bootstrap covers.
std::vector<Agreement> CompareIntervals(const FittedModel& model);

}  // namespace pushid
