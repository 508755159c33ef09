// ident: correlations over time, quantiles, tails.
#include "ident/problem/statistics.h"

#include <Eigen/Core>
#include <cmath>
#include <unsupported/Eigen/SpecialFunctions>

namespace pushid {
std::vector<double> CrossCorrelation(const std::vector<double>& series,
                                     const std::vector<double>& input, int num_lags) {
  const auto centred = [](const std::vector<double>& values) -> Eigen::VectorXd {
    const auto all = Eigen::VectorXd::Map(values.data(), static_cast<Eigen::Index>(values.size()));
    return all.array() - MeanOf(values).mean;
  };
  const Eigen::VectorXd e = centred(series), u = centred(input);
  const double power = std::sqrt(e.squaredNorm() * u.squaredNorm());
  std::vector<double> r(num_lags + 1, 0.0);
  if (power == 0.0) return r;
  for (int k = 0; k <= num_lags; ++k) {
    const Eigen::Index rest = std::max<Eigen::Index>(0, e.size() - k);
    r[k] = e.tail(rest).dot(u.head(rest)) / power;
  }
  return r;
}

std::vector<double> Autocorrelation(const std::vector<double>& series, int num_lags) {
  std::vector<double> r = CrossCorrelation(series, series, num_lags);
  r.erase(r.begin());
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

// By Newton's steps from the normal quantile: Student's tail is heavier there, and convex, so that
// none of them goes too far.
double StudentQuantile95(double v) {
  const double log_peak =
      std::lgamma(0.5 * (v + 1.0)) - std::lgamma(0.5 * v) - 0.5 * std::log(M_PI * v);
  double t = 1.959963984540054;
  for (int i = 0; i < 100; ++i) {
    const double density = std::exp(log_peak - 0.5 * (v + 1.0) * std::log1p(t * t / v));
    const double step = (StudentTail(t, v) - 0.05) / (2.0 * density);
    t += step;
    if (std::abs(step) < 1e-12 * t) break;
  }
  return t;
}

double Quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::nan("");
  std::sort(values.begin(), values.end());
  const double last = static_cast<double>(values.size()) - 1.0;
  const double at = std::clamp(share * static_cast<double>(values.size() + 1) - 1.0, 0.0, last);
  const size_t below = static_cast<size_t>(at);
  const size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (at - static_cast<double>(below)) * (values[above] - values[below]);
}

bool Within(const std::vector<double>& draws, double value, double share) {
  const double outside = 0.5 * (1.0 - share);
  return Quantile(draws, outside) <= value && value <= Quantile(draws, 1.0 - outside);
}

double Crps(std::vector<double> draws, double value) {
  std::sort(draws.begin(), draws.end());
  const double n = static_cast<double>(draws.size());
  double to_value = 0.0, apart = 0.0;
  for (size_t i = 0; i < draws.size(); ++i) {
    to_value += std::abs(draws[i] - value);
    apart += draws[i] * (2.0 * static_cast<double>(i) + 1.0 - n);  // sum over pairs, sorted
  }
  return to_value / n - apart / (n * (n - 1.0));
}

std::vector<double> MovingMean(const std::vector<double>& path, int half) {
  const int frames = static_cast<int>(path.size());
  std::vector<double> smooth;
  for (int t = 0; t < frames; ++t) {
    const int from = std::max(0, t - half), to = std::min(frames - 1, t + half);
    double sum = 0.0;
    for (int k = from; k <= to; ++k) sum += path[k];
    smooth.push_back(sum / (to - from + 1));
  }
  return smooth;
}

std::vector<int> TurnsOf(const std::vector<double>& path, double drop) {
  std::vector<int> turns;
  if (path.empty()) return turns;
  int most = 0, least = 0, heading = 0;  // 0: neither way yet
  for (int t = 1; t < static_cast<int>(path.size()); ++t) {
    if (path[t] > path[most]) most = t;
    if (path[t] < path[least]) least = t;
    if (heading >= 0 && path[most] - path[t] >= drop) {
      if (heading > 0) turns.push_back(most);
      heading = -1;
      least = t;
    } else if (heading <= 0 && path[t] - path[least] >= drop) {
      if (heading < 0) turns.push_back(least);
      heading = 1;
      most = t;
    }
  }
  return turns;
}

}  // namespace pushid
