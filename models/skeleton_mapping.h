// models: from a skeleton (hip and ankles) to the pendulum, and the two conventions for the angles.
//
// The cart is the midpoint of the ankles; u = (hip - cart) / |hip - cart|.
//   exact (default): theta = asin(u_x), phi = atan2(-u_y, u_z): inverse of HipPosition.
//   LDP:             phi = asin(-u_y), theta = atan2(u_x, u_z): u_y = -sin(phi), u_x = sin(theta)
//                    cos(phi), as LDP's released code maps; off by up to 5 mm under HipPosition
//                    (1 cm in groups). For comparison only.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

#include "models/enum_names.h"
#include "models/ipm.h"

namespace pushid {

enum class SkeletonMapping { kExact, kLdp };
constexpr EnumNames<SkeletonMapping, 2> Names(SkeletonMapping) {
  return {{{"exact", SkeletonMapping::kExact}, {"ldp", SkeletonMapping::kLdp}}};
}

struct MappedPose {
  Vector4<double> q;   // [x, y, theta, phi]
  double rod_length;   // m
  double cart_height;  // m
};

inline MappedPose MapSkeleton(const Vector3<double>& hip, const Vector3<double>& left_ankle,
                              const Vector3<double>& right_ankle, SkeletonMapping mapping) {
  const Vector3<double> cart = 0.5 * (left_ankle + right_ankle);
  const double length = (hip - cart).norm();
  const Vector3<double> u = (hip - cart) / length;
  const auto arcsine = [](double value) { return std::asin(std::clamp(value, -1.0, 1.0)); };
  const bool exact = mapping == SkeletonMapping::kExact;
  const double theta = exact ? arcsine(u.x()) : std::atan2(u.x(), u.z());
  const double phi = exact ? std::atan2(-u.y(), u.z()) : arcsine(-u.y());
  return {{cart.x(), cart.y(), theta, phi}, length, cart.z()};
}

// Smoothing and differentiating a sampled signal by local polynomials.
//
// Savitzky & Golay, Analytical Chemistry 36 (1964): a cubic is fitted to the 2 k + 1 samples around
// each one; near the ends the window keeps its length and the polynomial is read off centre.

struct SmoothedSample {
  Eigen::Vector4d value, rate, acceleration;
};

// window: odd, at least 5; shortened (to the largest odd number) where the signal is shorter.
// A signal of fewer than 5 samples is returned as it is, with zero derivatives.
std::vector<SmoothedSample> SavitzkyGolay(const std::vector<Eigen::Vector4d>& samples, int window,
                                          double dt);

}  // namespace pushid
