// models: a pendulum seen in axes that are turned about the vertical. The angles are no vector: the
// rod is one, u = (sin theta, -cos theta sin phi, cos theta cos phi), and turns exactly.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <cmath>

#include "models/ipm.h"

namespace pushid {

class TurnedAxes {
 public:
  // angle: rad, from the old x axis to the new one.
  explicit TurnedAxes(double angle) : c_(std::cos(angle)), s_(std::sin(angle)) {}

  // A horizontal vector of the old axes in the new ones.
  Eigen::Vector2d Horizontal(const Eigen::Vector2d& v) const {
    return {c_ * v[0] + s_ * v[1], -s_ * v[0] + c_ * v[1]};
  }
  Vector3<double> Point(const Vector3<double>& v) const {
    const Eigen::Vector2d h = Horizontal(v.head<2>());
    return {h[0], h[1], v[2]};
  }

  // [x, y, theta, phi].
  Vector4<double> Pose(const Vector4<double>& q) const {
    const Eigen::Vector2d cart = Horizontal(q.head<2>());
    const Vector3<double> rod = Point(Rod(q));
    return {cart[0], cart[1], std::asin(rod[0]), std::atan2(-rod[1], rod[2])};
  }

  // d pose' / d pose.
  Matrix4<double> PoseJacobian(const Vector4<double>& q) const {
    const double s_th = std::sin(q[2]), c_th = std::cos(q[2]);
    const double s_ph = std::sin(q[3]), c_ph = std::cos(q[3]);
    Eigen::Matrix<double, 3, 2> by;  // of the turned rod, by theta and phi
    by.col(0) = Point({c_th, s_th * s_ph, -s_th * c_ph});
    by.col(1) = Point({0.0, -c_th * c_ph, -c_th * s_ph});
    const Vector3<double> rod = Point(Rod(q));
    const double upright = rod[1] * rod[1] + rod[2] * rod[2];
    Matrix4<double> jacobian = Matrix4<double>::Zero();
    jacobian.topLeftCorner<2, 2>() << c_, s_, -s_, c_;
    jacobian.block<1, 2>(2, 2) = by.row(0) / std::sqrt(upright);
    jacobian.block<1, 2>(3, 2) = (rod[1] * by.row(2) - rod[2] * by.row(1)) / upright;
    return jacobian;
  }

  // A generalized force at a pose: the same power in the new coordinates.
  Vector4<double> Force(const Vector4<double>& q, const Vector4<double>& force) const {
    const Eigen::Matrix2d angles = PoseJacobian(q).bottomRightCorner<2, 2>().transpose();
    Vector4<double> turned;
    turned.head<2>() = Horizontal(force.head<2>());
    turned.tail<2>() = angles.inverse() * force.tail<2>();
    return turned;
  }

 private:
  static Vector3<double> Rod(const Vector4<double>& q) {
    return {std::sin(q[2]), -std::cos(q[2]) * std::sin(q[3]), std::cos(q[2]) * std::cos(q[3])};
  }
  double c_, s_;
};

}  // namespace pushid
