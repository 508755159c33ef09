// models: from a skeleton (hip and ankles) to the pendulum.
//
// The cart is the midpoint of the ankles; with u = (hip - cart) / |hip - cart|
//   theta = asin(u_x), phi = atan2(-u_y, u_z): the inverse of HipPosition.
// LDP's released code has phi = asin(-u_y), theta = atan2(u_x, u_z), off by up to 5 mm under
// HipPosition (1 cm in groups).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/ipm.h"

namespace pushid {

struct MappedPose {
  Vector4<double> q;   // [x, y, theta, phi]
  double rod_length;   // m
  double cart_height;  // m
};

MappedPose MapSkeleton(const Vector3<double>& hip, const Vector3<double>& left_ankle,
                       const Vector3<double>& right_ankle);

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
