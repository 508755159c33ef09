// models: derivatives of the pendulum's tip and of its turned path.
#include "models/restoration/body_tangent.h"

#include <cmath>

#include "models/restoration/window_restoration.h"

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

namespace {

FramePath<TurnedBlock> TurnedPathOf(const RestorationInput& person, double heading,
                                    const BodyTangent::PathDerivatives& derivatives) {
  std::vector<TurnedBlock> turned;
  for (size_t t = 0; t < person.q.size(); ++t) {
    turned.push_back(TurnedDerivatives(person.q[t], -heading, derivatives[t]));
  }
  return {std::move(turned), person.dt};
}

}  // namespace

WindowTangent::WindowTangent(const WindowWeights& weights)
    : mean_(weights.inputs.mean.cast<double>()), spread_(weights.inputs.spread.cast<double>()) {
  for (const DenseLayer& layer : weights.network.layers) {
    layers_.push_back({layer.weights.cast<double>(), layer.bias.cast<double>()});
  }
}

void WindowTangent::Forward(Eigen::VectorXd* x, Eigen::MatrixXd* dx) const {
  for (size_t l = 0; l < layers_.size(); ++l) {
    *x = (layers_[l].weights * *x + layers_[l].bias).eval();
    *dx = (layers_[l].weights * *dx).eval();
    if (l + 1 == layers_.size()) return;
    // ELU: e^x - 1 below zero, whose slope is e^x.
    for (Eigen::Index i = 0; i < x->size(); ++i) {
      if ((*x)[i] >= 0.0) continue;
      const double e = std::exp((*x)[i]);
      (*x)[i] = e - 1.0;
      dx->row(i) *= e;
    }
  }
}

std::vector<BodyTangent::Joints> WindowTangent::At(const RestorationInput& person,
                                                   const PathDerivatives& derivatives,
                                                   const std::vector<int>& frames) const {
  const double heading = Heading(person.first_pose);
  const Eigen::Matrix3d turn = TurnAboutZ(heading);
  const Eigen::MatrixXd of_person = WindowPersonInputs(person).cast<double>();
  const auto path = TurnedPath(person, heading);
  const bool with = !derivatives.empty();
  const Eigen::Index columns = with ? derivatives.front().cols() : 0;
  const FramePath<TurnedBlock> by_path =
      with ? TurnedPathOf(person, heading, derivatives)
           : FramePath<TurnedBlock>({TurnedBlock(4, 0)}, person.dt);
  std::vector<Joints> all;
  for (const int t : frames) {
    Eigen::VectorXd x(kWindowPendulumInputs + of_person.rows());
    FillPendulumInputs(path, person.dt, t, x.head(kWindowPendulumInputs));
    x.tail(of_person.rows()) = of_person.col(t);
    x[kWindowRodInput] = person.BodyAt(t).rod_length;  // not rounded
    x = (x - mean_).cwiseQuotient(spread_);
    Eigen::MatrixXd dx = Eigen::MatrixXd::Zero(x.size(), columns);
    if (with) {
      FillPendulumInputs(by_path, person.dt, t, dx.topRows(kWindowPendulumInputs));
      dx.row(kWindowRodInput) = derivatives[t].row(4);
    }
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      dx.row(i) *= std::abs(x[i]) < kLargestScaled ? 1.0 / spread_[i] : 0.0;
    }
    x = x.cwiseMax(-kLargestScaled).cwiseMin(kLargestScaled);
    Forward(&x, &dx);
    Joints joints{Eigen::VectorXd(3 * kBodyJoints), Eigen::MatrixXd(3 * kBodyJoints, columns)};
    const Eigen::Vector3d tip = TipAt(person, t);
    Eigen::Matrix3Xd tip_by(3, columns);
    if (with) tip_by = TipDerivatives(person, t, derivatives[t]);
    joints.positions.head<3>() = tip;
    joints.derivatives.topRows(3) = tip_by;
    for (int j = 1; j < kBodyJoints; ++j) {
      const Eigen::Vector3d first = person.first_pose.col(j) - person.first_pose.col(0);
      joints.positions.segment<3>(3 * j) = tip + first + turn * x.segment<3>(3 * (j - 1));
      joints.derivatives.middleRows(3 * j, 3) = tip_by + turn * dx.middleRows(3 * (j - 1), 3);
    }
    all.push_back(std::move(joints));
  }
  return all;
}

}  // namespace pushid
