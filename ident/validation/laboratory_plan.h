// ident: what a laboratory's equipment would tell: force platforms under the same recordings, and
// as many recordings again on a platform that moves, with force platforms or without.
//
// With H the Hessian of the cost, of which priors are the part P, V the covariance of the data's
// scatter, clustered by person (or by recording, where nobody was recorded twice), sigma^2 the
// variance of rows and I the information of those to come (their J'J, rolled out at the estimate),
// what scatters today's estimate has today's weight among all rows, and the rows to come scatter by
// their noise:
//   V' = (H + I)^-1 (H V H + P + sigma^2 I) (H + I)^-1 + B,   over the same without I and B
// B: what people evidently differ by, over their number, which no equipment makes smaller: a 90 %
// lower bound, since the estimate itself is mostly noise where little is known yet. Rejected: V - N
// + (N^-1 + I)^-1, N = H^-1, which keeps all that is not noise today (promised 0.9 where 0.03
// came). Platforms are taken as exact to 3 N and 2 mm of the centre of pressure, or as those of the
// fit are.
#pragma once

#include <string>
#include <vector>

namespace pushid {

class FitProblem;
struct FitPoint;
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
