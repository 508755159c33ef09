// ident: a contrast, the difference of every parameter between two values of a label.
//
// With b the fitted slope of a parameter and s its shared value on the fitted scale (log of a
// positive parameter), people have natural(s - b/2) where the label has its first value and
// natural(s + b/2) where it has its second, so that where the same people are in both they are
// compared with themselves: their scores go into one cluster, and what they have in common drops
// out. The result has
//   difference   natural(s + b/2) - natural(s - b/2), its interval by the delta method, from the
//                same parts of the covariance as every other interval (covariance.h)
//   p            of b = 0: the level at which the interval of b ends at 0
//   Holm's p     corrected for all parameters of the contrast (Holm 1979), so that the chance of
//                any false positive among them is at most the level
//
// People who were recorded alone are judged by a t-test of their own fits instead (OwnEstimate),
// which finds as many true differences as a test in two stages does, the joint fit half of them
// (tests/studies/contrast.py): the joint fit weighs everything that nothing excited against the
// data, and counts the width of priors as scatter.
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
  // In standard deviations between people, as their own fits scatter.
  std::optional<double> effect;
  EstimateStatus status = EstimateStatus::kIdentified;  // of the slope
};

struct Contrast {
  std::string label, first, second;
  // People by id, in order of first appearance.
  std::vector<std::string> only_first, only_second, both;
  std::vector<ContrastRow> rows;  // in the order of the table of parameters
};

// The level at which an interval of half-width sqrt(sum of t_k^2 V_k) ends at 0 (covariance.h); 1
// where nothing is known of the error.
double ProbabilityOfZero(const Scatter& scatter, const Eigen::VectorXd& coefficients, double value);

// A parameter's estimate by a person's own recordings with one value of the label alone.
struct OwnEstimate {
  std::string person;
  bool second = false;  // value of the label
  double fitted = 0.0;  // on the fitted scale
};

// Student's test of people's own estimates, one for each person and value: Welch's test if nobody
// has both values, a paired test if all people have both. If some have both, the test uses their
// covariance, with one degree of freedom less than the smaller group has people. Sets values (means
// on the fitted scale), difference, interval, p and effect. Returns false and sets nothing if a
// value has fewer than two people, or there is no scatter.
bool JudgeByPeople(Transform transform, const std::vector<OwnEstimate>& people, ContrastRow* row);

// Holm's p of all rows: with the m p values in ascending order, the largest of (m - k + 1) p_k up
// to each, at most 1. Unidentifiable rows are not counted and have 1.
void CorrectForRows(Contrast* contrast);

// None where the fit has no contrast.
std::optional<Contrast> ContrastAt(const FitProblem& problem, const FitPoint& point,
                                   const Uncertainty& uncertainty);

}  // namespace pushid
