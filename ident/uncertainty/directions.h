// ident: which parameters the data cannot tell apart, which sums of them they can, and which
// combinations priors decide.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "ident/problem/fit_problem.h"
#include "ident/uncertainty/covariance.h"
#include "ident/uncertainty/uncertainty.h"

namespace pushid {

inline constexpr double kTouched = 1e-4;  // share of a null direction that counts

// null_space: columns over all fitted numbers, in units of each one's scale. `uncertainty` needs
// its covariance and quantile only.
std::vector<NullDirection> DescribeNullSpace(const FitProblem& problem, const FitPoint& point,
                                             const Eigen::MatrixXd& null_space,
                                             const Uncertainty& uncertainty);

// Directions that the data hardly know: where priors and demands decide.
//
// H = H_data + H_put_in over the shared parameters (deviations of units integrated out). The
// eigenvalues of H^-1/2 H_data H^-1/2 are the data's shares, direction by direction; along one
// whose share is below 50 % the estimate is what was put in. Where two parameters make most of it,
// the data still know a combination of the two.

inline constexpr double kHeldShare = 0.5;  // of the data; with less, what was put in decides

// One sentence for each. at_bound: columns that do not move.
std::vector<std::string> HeldDirections(const FitProblem& problem, const FitPoint& point,
                                        const Covariance& covariance,
                                        const std::vector<bool>& at_bound);

}  // namespace pushid
