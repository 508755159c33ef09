// models: what the learned terms of a person see of that person, in units of typical ranges, and
// how they read matrices from a flat array of weights.
#pragma once

#include <Eigen/Core>

#include "models/ipm.h"

namespace pushid {

template <typename T>
using VectorX = Eigen::Matrix<T, Eigen::Dynamic, 1>;
// Rows of a matrix in a flat array, each followed by the next after a stride.
template <typename T>
using ConstRows =
    Eigen::Map<const Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>, 0,
               Eigen::OuterStride<>>;

inline constexpr double kNetworkAngle = 0.15;        // rad
inline constexpr double kNetworkSpeed = 0.8;         // m/s
inline constexpr double kNetworkRate = 0.6;          // rad/s
inline constexpr double kNetworkRod = 0.05;          // m
inline constexpr double kNetworkMass = 20.0;         // kg
inline constexpr double kNetworkAcceleration = 2.0;  // m/s^2 and m^2/s^2, of forces over the mass

inline constexpr int kMotionInputs = 6;

// The first of u: e = (theta, phi) less the posture, and the velocities.
template <typename T>
void SetMotionInputs(const T& e_theta, const T& e_phi, const Vector4<T>& qd, VectorX<T>* u) {
  (*u)[0] = e_theta / kNetworkAngle;
  (*u)[1] = e_phi / kNetworkAngle;
  (*u)[2] = qd[0] / kNetworkSpeed;
  (*u)[3] = qd[1] / kNetworkSpeed;
  (*u)[4] = qd[2] / kNetworkRate;
  (*u)[5] = qd[3] / kNetworkRate;
}

// Their derivatives by [theta, phi, qd].
inline Eigen::Matrix<double, kMotionInputs, 1> MotionInputScales() {
  Eigen::Matrix<double, kMotionInputs, 1> scales;
  scales << kNetworkAngle, kNetworkAngle, kNetworkSpeed, kNetworkSpeed, kNetworkRate, kNetworkRate;
  return scales.cwiseInverse();
}

}  // namespace pushid
