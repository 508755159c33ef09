// models: transitions counted and compared.
#include "models/transition_statistics.h"

#include <algorithm>
#include <cmath>

namespace pushid {

Eigen::MatrixXd CountTransitions(const std::vector<Symbols>& people, int num_symbols,
                                 Transitions which) {
  Eigen::MatrixXd counts = Eigen::MatrixXd::Zero(num_symbols, num_symbols);
  for (const Symbols& symbols : people) {
    for (size_t t = 1; t < symbols.size(); ++t) counts(symbols[t - 1], symbols[t]) += 1.0;
  }
  if (which == Transitions::kChanges) counts.diagonal().setZero();
  return counts;
}

std::optional<double> JensenShannon(const Eigen::MatrixXd& p, const Eigen::MatrixXd& q) {
  if (!(p.sum() > 0.0) || !(q.sum() > 0.0)) return std::nullopt;
  double divergence = 0.0;
  for (Eigen::Index i = 0; i < p.size(); ++i) {
    const double a = p.data()[i] / p.sum(), b = q.data()[i] / q.sum(), mean = 0.5 * (a + b);
    if (a > 0.0) divergence += 0.5 * a * std::log(a / mean);
    if (b > 0.0) divergence += 0.5 * b * std::log(b / mean);
  }
  return std::sqrt(std::max(0.0, divergence));  // rounding may leave less than nothing
}

}  // namespace pushid
