// ident: what a contrast says: the difference of every parameter between two values of a label.
//
// With b the fitted slope of a parameter and s its shared value on the fitted scale (log of a
// positive parameter), people have natural(s - b/2) where the label has its first value and
// natural(s + b/2) where it has its second, so that where the same people are in both they are
// compared with themselves: their scores go into one cluster, and what they have in common drops
// out. Of these are
//   difference   natural(s + b/2) - natural(s - b/2), its interval by the delta method, from the
//                same parts of the covariance as every other interval (covariance.h)
//   p            of b = 0: the level at which the interval of b ends at 0
//   Holm's p     the same, corrected for all parameters of the contrast (Holm 1979): with the m
//                p values in ascending order, the largest of (m - k + 1) p_k up to each, at most 1.
//                The chance of any false positive among them is then at most the level.
//   effect       b over the standard deviation between people, both on the fitted scale; of fits
//                in which people differ (--pool=... --pool_by=subject) that of the fit, of others
//                that of a second one (fit/covariates.h)
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ident/uncertainty/uncertainty.h"

namespace pushid {

class FitProblem;
struct FitPoint;

struct ContrastRow {
  std::string name, unit;            // of the parameter
  double first = 0.0, second = 0.0;  // its values, natural unit
  double difference = 0.0;           // second less first, natural unit
  double lower95 = 0.0, upper95 = 0.0;
  double p = 1.0, p_holm = 1.0;
  std::optional<double> effect;                         // in standard deviations between people
  EstimateStatus status = EstimateStatus::kIdentified;  // of the slope
};

struct Contrast {
  std::string label, first, second;
  // People by id, in order of first appearance.
  std::vector<std::string> only_first, only_second, both;
  std::vector<ContrastRow> rows;  // in the order of the table of parameters
};

// Holm's, in the order of `p`. Those that are NaN count as 1.
std::vector<double> HolmCorrected(const std::vector<double>& p);

// The level at which an interval of half-width sqrt(sum of t_k^2 V_k) ends at 0 (covariance.h); 1
// where nothing is known of the error.
double ProbabilityOfZero(const Scatter& scatter, const Eigen::VectorXd& coefficients, double value);

// None where the fit has no contrast.
std::optional<Contrast> ContrastAt(const FitProblem& problem, const FitPoint& point,
                                   const Uncertainty& uncertainty);

}  // namespace pushid
