// ident: updates of the curvature, and the rows that stand for it.
#include "ident/solver/structured_secants.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>

#include "models/decompositions.h"

namespace pushid {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

// The first S keeps at least so much of J'J: one step tells of one direction.
constexpr double kFirstShare = 0.3;
// S is given up where it is so many times as far as J'J from what a step brought, until it is
// nearer.
constexpr double kClearly = 20.0;
// Least curvature along a step that is learned from, and of B in any direction, to that of J'J.
constexpr double kLeastLearned = 1e-3, kLeastCurvature = 0.1;
constexpr double kLeastPart = 1e-3;    // of S
constexpr double kLeastPivot = 1e-14;  // of a column's own (residuals/normal_equations.h)

}  // namespace

void StructuredSecants::Add(const VectorXd& x, double cost, const SecondOrder& curved,
                            const SecondOrder& linear) {
  if (x_.size() == 0) {
    if (beyond_.size() == 0) beyond_ = MatrixXd::Zero(x.size(), x.size());
  } else if (learns_ && x != x_) {
    const VectorXd step = x - x_;
    Judge(step, cost_ - cost);
    Learn(step, curved, linear);
  }
  x_ = x;
  cost_ = cost;
  curved_gradient_ = curved.gradient;
  gradient_ = curved.gradient + linear.gradient;
  information_ = curved.information + linear.information;
}

// Whether the last step's fall of the cost is as J'J foretold, and nothing like what S did.
void StructuredSecants::Judge(const VectorXd& step, double fall) {
  const double plain = -(gradient_.dot(step) + 0.5 * step.dot(information_ * step));
  const double with = plain - 0.5 * step.dot(beyond_ * step);
  const double off_plain = std::abs(plain - fall), off_with = std::abs(with - fall);
  use_ = beyond_.isZero(0.0) || off_with < (use_ ? kClearly : 1.0) * off_plain;
}

void StructuredSecants::Learn(const VectorXd& step, const SecondOrder& curved,
                              const SecondOrder& linear) {
  const VectorXd by_curved = curved.information * step;
  const VectorXd y = curved.gradient - curved_gradient_;
  const double known = step.dot(by_curved), seen = step.dot(y);
  if (!(known > 0.0)) return;
  if (beyond_.isZero(0.0)) {
    beyond_ = (std::clamp(seen / known, kFirstShare, 1.0) - 1.0) * curved.information;
  } else {
    const double told = std::abs(step.dot(beyond_ * step));
    beyond_ *= told > 0.0 ? std::min(1.0, std::abs(seen - known) / told) : 1.0;
  }
  const VectorXd by_linear = linear.information * step;
  const VectorXd b = by_curved + by_linear + beyond_ * step, turned = y + by_linear;
  const double by_b = step.dot(b), by_turned = step.dot(turned);
  const double least = kLeastLearned * (known + step.dot(by_linear));
  if (by_b < least || by_turned < least) return;
  beyond_ += turned * turned.transpose() / by_turned - b * b.transpose() / by_b;
}

RowMajorMatrix StructuredSecants::Rows() const {
  const Eigen::Index size = x_.size();
  VectorXd length = information_.diagonal().cwiseSqrt();
  length = (length.array() > 0.0).select(length, 1.0);
  const auto scale = length.cwiseInverse().asDiagonal();
  MatrixXd scaled = scale * information_ * scale;
  scaled.diagonal().array() += kLeastPivot;
  MatrixXd root = CholeskyFactor(scaled);
  if (root.size() == 0) {  // rounding
    scaled.diagonal().array() += std::sqrt(kLeastPivot);
    root = CholeskyFactor(scaled);
    CHECK_GT(root.size(), 0);
  }
  const auto lower = root.triangularView<Eigen::Lower>();
  const VectorXd z = lower.solve(scale * gradient_);
  RowMajorMatrix rows = RowMajorMatrix::Zero(size + 1, size + 1);
  const auto set = [&](const MatrixXd& b, const VectorXd& at) {
    rows.topLeftCorner(size, size) = b * length.asDiagonal();
    rows.col(size).head(size) = at;
    rows(size, size) = std::sqrt(std::max(0.0, 2.0 * cost_ - at.squaredNorm()));
  };
  set(root.transpose(), z);
  if (!use_ || beyond_.isZero(0.0)) return rows;
  const MatrixXd half = lower.solve(scale * beyond_ * scale);
  const SymmetricEigen ratio = DecomposeSymmetric(lower.solve(half.transpose()));
  const VectorXd along = ratio.vectors.transpose() * z;
  VectorXd share, turned;
  // As much of S as leaves the cost above nothing: no rows have one below.
  double part = 2.0;
  do {
    part *= 0.5;
    share = (1.0 + part * ratio.values.array()).max(kLeastCurvature).sqrt();
    turned = along.cwiseQuotient(share);
  } while (turned.squaredNorm() > 2.0 * cost_ && part > kLeastPart);
  if (part <= kLeastPart) return rows;
  set(share.asDiagonal() * ratio.vectors.transpose() * root.transpose(), turned);
  return rows;
}

}  // namespace pushid
