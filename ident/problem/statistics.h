// ident: statistics of residuals, errors and draws.
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

// The value at a share of the sorted ones, interpolated: the i-th of n stands at i / (n + 1).
double Quantile(std::vector<double> values, double share);

// Whether the value lies in the central `share` of the draws.
bool Within(const std::vector<double>& draws, double value, double share);

// Unbiased CRPS of draws against a value, and of vectors the energy score: the mean distance of
// draws to the value less half of that between draws (Gneiting and Raftery 2007, Eq. 20 and 22).
double Crps(std::vector<double> draws, double value);
template <typename Vector>
double EnergyScore(const std::vector<Vector>& draws, const Vector& value) {
  double to_value = 0.0, apart = 0.0;
  for (size_t i = 0; i < draws.size(); ++i) {
    to_value += (draws[i] - value).norm();
    for (size_t j = 0; j < i; ++j) apart += (draws[i] - draws[j]).norm();
  }
  const double n = static_cast<double>(draws.size());
  return to_value / n - apart / (n * (n - 1.0));
}

// Two-sided 95 % quantile of Student's t; at least one degree of freedom.
double StudentQuantile95(double degrees_of_freedom);
// Probability that |T| exceeds |t|.
double StudentTail(double t, double degrees_of_freedom);

// The mean over so many values to both sides, fewer at the ends.
std::vector<double> MovingMean(const std::vector<double>& path, int half);
// Frames at which a path turns: extremes from which it goes back by at least `drop`.
std::vector<int> TurnsOf(const std::vector<double>& path, double drop);

}  // namespace pushid
