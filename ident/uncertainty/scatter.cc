// ident: sums of independent parts of an estimate's scatter.
#include <algorithm>
#include <cmath>
#include <limits>

#include "ident/problem/statistics.h"
#include "ident/uncertainty/covariance.h"

namespace pushid {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kNormal95 = 1.959963984540054;
constexpr double kMatters = 1e-6;  // of the variance

double QuantileOf(double freedom) {
  return std::isfinite(freedom) ? StudentQuantile95(freedom) : kNormal95;
}

double LeastFreedom(const Eigen::VectorXd& freedom, const Eigen::VectorXd& coefficients) {
  double least = kInfinite;
  for (Eigen::Index i = 0; i < coefficients.size(); ++i) {
    if (coefficients[i] != 0.0) least = std::min(least, freedom[i]);
  }
  return least;
}

}  // namespace

void Scatter::Add(const Eigen::MatrixXd& covariance, double freedom) {
  parts.push_back({covariance, Eigen::VectorXd::Constant(covariance.rows(), freedom)});
}

Eigen::MatrixXd Scatter::Covariance() const {
  Eigen::MatrixXd sum;
  for (const Part& part : parts) {
    sum = sum.size() == 0 ? part.covariance : Eigen::MatrixXd(sum + part.covariance);
  }
  return sum;
}

ScatterOf Scatter::Of(const Eigen::VectorXd& coefficients) const {
  std::vector<double> variances, freedoms;
  double sum = 0.0, squared_width = 0.0;
  for (const Part& part : parts) {
    variances.push_back(std::max(0.0, coefficients.dot(part.covariance * coefficients)));
    freedoms.push_back(LeastFreedom(part.freedom, coefficients));
    const double quantile = QuantileOf(freedoms.back());
    sum += variances.back();
    squared_width += quantile * quantile * variances.back();
  }
  ScatterOf of;
  of.standard_error = std::sqrt(sum);
  of.freedom = parts.empty() ? 1.0 : kInfinite;
  for (size_t k = 0; k < parts.size(); ++k) {
    if (variances[k] >= kMatters * sum) of.freedom = std::min(of.freedom, freedoms[k]);
  }
  of.quantile = sum > 0.0 ? std::sqrt(squared_width / sum) : QuantileOf(of.freedom);
  return of;
}

ScatterOf Scatter::OfColumn(Eigen::Index column) const {
  return Of(Eigen::VectorXd::Unit(parts.empty() ? column + 1 : parts[0].covariance.rows(), column));
}

}  // namespace pushid
