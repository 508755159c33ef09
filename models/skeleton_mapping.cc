// models: from a skeleton to the pendulum, and local cubic least squares.
#include "models/skeleton_mapping.h"

#include <algorithm>
#include <cmath>

#include "models/decompositions.h"

namespace pushid {

MappedPose MapSkeleton(const Vector3<double>& hip, const Vector3<double>& left_ankle,
                       const Vector3<double>& right_ankle) {
  const Vector3<double> cart = 0.5 * (left_ankle + right_ankle);
  const double length = (hip - cart).norm();
  const Vector3<double> u = (hip - cart) / length;
  const double theta = std::asin(std::clamp(u.x(), -1.0, 1.0));
  const double phi = std::atan2(-u.y(), u.z());
  return {{cart.x(), cart.y(), theta, phi}, length, cart.z()};
}

std::vector<SmoothedSample> SavitzkyGolay(const std::vector<Eigen::Vector4d>& samples, int window,
                                          double dt) {
  const int n = static_cast<int>(samples.size());
  std::vector<SmoothedSample> result(n);
  const int width = std::min(window, n % 2 == 1 ? n : n - 1);
  if (width < 5) {
    for (int i = 0; i < n; ++i) {
      result[i] = {samples[i], Eigen::Vector4d::Zero(), Eigen::Vector4d::Zero()};
    }
    return result;
  }

  // One pseudo-inverse serves every window: columns 1, k, k^2, k^3 over k = 0 .. width - 1.
  Eigen::MatrixXd basis(width, 4);
  for (int k = 0; k < width; ++k) basis.row(k) << 1.0, k, k * k, k * k * k;
  const Eigen::MatrixXd inverse = PseudoInverse(basis);
  Eigen::MatrixXd window_samples(width, 4);
  for (int i = 0; i < n; ++i) {
    const int first = std::clamp(i - width / 2, 0, n - width);
    for (int k = 0; k < width; ++k) window_samples.row(k) = samples[first + k].transpose();
    const Eigen::Matrix4d c = inverse * window_samples;  // coefficients x components
    const double k = i - first;
    result[i].value =
        (c.row(0) + k * c.row(1) + k * k * c.row(2) + k * k * k * c.row(3)).transpose();
    result[i].rate = (c.row(1) + 2 * k * c.row(2) + 3 * k * k * c.row(3)).transpose() / dt;
    result[i].acceleration = (2 * c.row(2) + 6 * k * c.row(3)).transpose() / (dt * dt);
  }
  return result;
}

}  // namespace pushid
