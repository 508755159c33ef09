// ident: statistics of residuals and errors: correlations over time, means with their errors,
// medians, and tails of chi-squared and Student's t.
#pragma once

#include <algorithm>
#include <vector>

namespace pushid {

// r_k = sum e_t e_{t-k} / sum e_t^2, e less its mean, lags 1 .. num_lags; zeros for a constant.
std::vector<double> Autocorrelation(const std::vector<double>& series, int num_lags);

// Correlation of e_t with u_{t-k}, lags 0 .. num_lags, both less their means.
std::vector<double> CrossCorrelation(const std::vector<double>& series,
                                     const std::vector<double>& input, int num_lags);

// Q = n (n + 2) sum r_k^2 / (n - k): chi-square with as many degrees of freedom as lags when the
// series is white (Ljung & Box 1978).
double LjungBox(const std::vector<double>& autocorrelation, int length);

// P(chi-square of so many degrees of freedom > value).
double ChiSquareTail(double value, int degrees_of_freedom);

// Mean, and standard error of the mean.
struct MeanAndError {
  double mean = 0.0, error = 0.0;
};
MeanAndError MeanOf(const std::vector<double>& values);

// The median; of an even number, the mean of the middle two. values: at least one.
inline double Median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

// Two-sided 95 % quantile of Student's t; at least one degree of freedom.
double StudentQuantile95(double degrees_of_freedom);
// Probability that |T| exceeds |t|.
double StudentTail(double t, double degrees_of_freedom);

}  // namespace pushid
