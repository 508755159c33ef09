// models: derivatives of the pendulum's tip and of its turned path.
#include "models/restoration/body_tangent.h"

#include <cmath>

namespace pushid {
namespace {

// The rod's direction r(theta, phi), and its derivatives by the two.
struct Rod {
  explicit Rod(const Vector4<double>& q) {
    const double st = std::sin(q[2]), ct = std::cos(q[2]), sp = std::sin(q[3]), cp = std::cos(q[3]);
    direction << st, -ct * sp, ct * cp;
    by_angles << ct, 0.0, st * sp, -ct * cp, -st * cp, -ct * sp;
  }
  Eigen::Vector3d direction;
  Eigen::Matrix<double, 3, 2> by_angles;
};

}  // namespace

TurnedBlock TurnedDerivatives(const Vector4<double>& q, double angle,
                              const BodyTangent::PathBlock& derivatives) {
  const Eigen::Matrix3d turn = TurnAboutZ(angle);
  const Rod rod(q);
  const Eigen::Vector3d r = turn * rod.direction;
  const Eigen::Matrix<double, 3, 2> dr = turn * rod.by_angles;
  Eigen::Matrix4d by_q = Eigen::Matrix4d::Zero();
  by_q.topLeftCorner<2, 2>() = turn.topLeftCorner<2, 2>();
  by_q.block<1, 2>(2, 2) = dr.row(0) / std::sqrt(1.0 - r.x() * r.x());
  by_q.block<1, 2>(3, 2) =
      (r.y() * dr.row(2) - r.z() * dr.row(1)) / (r.y() * r.y() + r.z() * r.z());
  return by_q * derivatives.topRows<4>();
}

Eigen::Matrix3Xd TipDerivatives(const RestorationInput& person, int frame,
                                const BodyTangent::PathBlock& derivatives) {
  const Rod rod(person.q[frame]);
  Eigen::Matrix3Xd by =
      person.BodyAt(frame).rod_length * rod.by_angles * derivatives.middleRows<2>(2);
  by += rod.direction * derivatives.row(4);
  by.topRows<2>() += derivatives.topRows<2>();
  by.row(2) += derivatives.row(5);
  return by;
}

}  // namespace pushid
