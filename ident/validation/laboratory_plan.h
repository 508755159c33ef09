// ident: what a laboratory's equipment would tell: force platforms under the same recordings, and
// as many recordings again on a platform that moves, with force platforms or without.
//
// With N the covariance that takes all errors for noise and V the one clustered by person (or by
// recording, where nobody was recorded twice), what is not noise stays, and noise has more
// information I (J'J of the rows to come, rolled out at the estimate, over sigma^2):
//   V' = V - N + (N^-1 + I)^-1, its diagonal, positive parts
// Platforms are taken as exact to 5 N and 3 mm of the centre of pressure, or as those of the fit
// are.
#pragma once

#include <string>
#include <vector>

#include "ident/problem/fit_point.h"

namespace pushid {

class FitProblem;
struct ErrorParts;

struct EquipmentRow {
  std::string equipment;            // "force platforms under the same recordings"
  std::vector<double> error_ratio;  // of each of the parameters asked for: then over now
};

// known: of the shared parameters, those that are asked for. Rows that a fall spoils, and equipment
// that the recordings have, are left out.
std::vector<EquipmentRow> PlanEquipment(const FitProblem& problem, const FitPoint& estimate,
                                        const ErrorParts& parts, const std::vector<int>& known);

}  // namespace pushid
