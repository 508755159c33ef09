// ident: saying which parameters cannot be told apart, and which sums of them still can.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "ident/uncertainty/uncertainty.h"

namespace pushid {

inline constexpr double kTouched = 1e-4;  // share of a null direction that counts

// null_space: columns over all fitted numbers, in units of each one's scale. `uncertainty` needs
// its covariance and quantile only.
std::vector<NullDirection> DescribeNullSpace(const FitProblem& problem, const FitPoint& point,
                                             const Eigen::MatrixXd& null_space,
                                             const Uncertainty& uncertainty);

}  // namespace pushid
