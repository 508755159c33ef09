// ident: correlations over time.
#include "ident/problem/statistics.h"

#include <cmath>
#include <unsupported/Eigen/SpecialFunctions>

namespace pushid {
namespace {

std::vector<double> Centred(std::vector<double> series) {
  double mean = 0.0;
  for (double value : series) mean += value / static_cast<double>(series.size());
  for (double& value : series) value -= mean;
  return series;
}

double Power(const std::vector<double>& series) {
  double sum = 0.0;
  for (double value : series) sum += value * value;
  return sum;
}

// sum over t of a_t b_{t-lag}.
double Lagged(const std::vector<double>& a, const std::vector<double>& b, size_t lag) {
  double sum = 0.0;
  for (size_t t = lag; t < a.size(); ++t) sum += a[t] * b[t - lag];
  return sum;
}

}  // namespace

std::vector<double> Autocorrelation(const std::vector<double>& series, int num_lags) {
  const std::vector<double> e = Centred(series);
  const double power = Power(e);
  std::vector<double> r(num_lags, 0.0);
  if (power == 0.0) return r;
  for (int k = 1; k <= num_lags; ++k) r[k - 1] = Lagged(e, e, k) / power;
  return r;
}

std::vector<double> CrossCorrelation(const std::vector<double>& series,
                                     const std::vector<double>& input, int num_lags) {
  const std::vector<double> e = Centred(series), u = Centred(input);
  const double power = std::sqrt(Power(e) * Power(u));
  std::vector<double> r(num_lags + 1, 0.0);
  if (power == 0.0) return r;
  for (int k = 0; k <= num_lags; ++k) r[k] = Lagged(e, u, k) / power;
  return r;
}

double LjungBox(const std::vector<double>& autocorrelation, int length) {
  const double n = length;
  double sum = 0.0;
  for (size_t k = 1; k <= autocorrelation.size(); ++k) {
    const double r = autocorrelation[k - 1];
    sum += r * r / (n - static_cast<double>(k));
  }
  return n * (n + 2.0) * sum;
}

double ChiSquareTail(double value, int degrees_of_freedom) {
  return Eigen::numext::igammac(0.5 * degrees_of_freedom, 0.5 * value);
}

MeanAndError MeanOf(const std::vector<double>& values) {
  MeanAndError result;
  const double n = static_cast<double>(values.size());
  if (values.empty()) return result;
  for (double value : values) result.mean += value / n;
  double squares = 0.0;
  for (double value : values) squares += (value - result.mean) * (value - result.mean);
  if (values.size() > 1) result.error = std::sqrt(squares / (n - 1.0) / n);
  return result;
}

// P(|T| > t) = I_{v / (v + t^2)}(v / 2, 1 / 2).
double StudentTail(double t, double v) {
  return Eigen::numext::betainc(0.5 * v, 0.5, v / (v + t * t));
}

double StudentQuantile95(double v) {
  double low = 0.0, high = 1000.0;
  for (int i = 0; i < 100; ++i) {
    const double t = 0.5 * (low + high);
    (StudentTail(t, v) > 0.05 ? low : high) = t;
  }
  return 0.5 * (low + high);
}

}  // namespace pushid
