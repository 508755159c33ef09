// models: Jacobians of the self force; tests hold them against automatic derivatives.
#include "models/self_force.h"

#include <algorithm>

namespace pushid {

double FootRate(double step) {
  constexpr double kFootTime = 0.02;  // s
  // Explicit in time: at 30 frames a second as well, but not much below.
  constexpr double kLeastOfStep = 0.6;
  return 1.0 / std::max(kFootTime, kLeastOfStep * step);
}

void SelfForce::FrictionJacobian(const ParameterSet<double>& p, const Vector4<double>& qd,
                                 Jacobian* jacobian) const {
  jacobian->by_state.setZero();
  jacobian->by_previous.setZero();
  jacobian->by_parameter.setZero();
  // By the cart's velocity and by friction's own parameters.
  constexpr int kParameters = kKpX - kMu;
  using FrictionDual = Dual<double, 2 + kParameters>;
  ParameterSet<FrictionDual> parameters;
  Vector4<FrictionDual> velocity;
  for (int i = 0; i < 2; ++i) velocity[i] = FrictionDual::Input(qd[i], i);
  for (int i = 0; i < kParameters; ++i) {
    parameters[kMu + i] = FrictionDual::Input(p[kMu + i], 2 + i);
  }
  const Vector4<FrictionDual> force = Friction(parameters, velocity);
  for (int row = 0; row < 2; ++row) {
    jacobian->by_state.row(row).segment<2>(4) = force[row].v.head<2>().transpose();
    jacobian->by_parameter.row(row).segment<kParameters>(kMu) =
        force[row].v.tail<kParameters>().transpose();
  }
}

void SelfForce::AddBalanceJacobian(const ParameterSet<double>& p,
                                   const PendulumState<double>& state,
                                   const Vector4<double>& qd_previous, Jacobian* jacobian) const {
  auto& by_state = jacobian->by_state;
  auto& by_parameter = jacobian->by_parameter;
  const double xd = state.qd[0], yd = state.qd[1], thd = state.qd[2], phd = state.qd[3];
  const double e_th = state.q[2] - posture[0], e_ph = state.q[3] - posture[1];
  by_state(0, 4) -= scale.force * p[kKpX];
  by_state(1, 5) -= scale.force * p[kKpY];
  by_state(2, 2) -= scale.stiffness * p[kKpTheta];
  by_state(2, 6) -= scale.damping * p[kKdTheta];
  by_state(3, 3) -= scale.stiffness * p[kKpPhi];
  by_state(3, 7) -= scale.damping * p[kKdPhi];
  by_parameter(0, kKpX) = -scale.force * xd;
  by_parameter(1, kKpY) = -scale.force * yd;
  by_parameter(2, kKpTheta) = -scale.stiffness * e_th;
  by_parameter(2, kKdTheta) = -scale.damping * thd;
  by_parameter(3, kKpPhi) = -scale.stiffness * e_ph;
  by_parameter(3, kKdPhi) = -scale.damping * phd;
  if (cart_derivative) {
    const Eigen::Vector2d rate(scale.force * p[kKdX] / dt, scale.force * p[kKdY] / dt);
    by_state(0, 4) -= rate[0];
    by_state(1, 5) -= rate[1];
    jacobian->by_previous = rate;
    by_parameter(0, kKdX) = -scale.force * (xd - qd_previous[0]) / dt;
    by_parameter(1, kKdY) = -scale.force * (yd - qd_previous[1]) / dt;
  }
}

void SelfForce::AddLinearJacobian(const ParameterSet<double>& p, const PendulumState<double>& state,
                                  Jacobian* jacobian) const {
  auto& by_state = jacobian->by_state;
  auto& by_parameter = jacobian->by_parameter;
  const double mass = body.mass, ml2 = PointInertia();
  const double xd = state.qd[0], yd = state.qd[1], thd = state.qd[2], phd = state.qd[3];
  const double e_th = state.q[2] - posture[0], e_ph = state.q[3] - posture[1];
  by_state(0, 2) += mass * p[kAx];
  by_state(0, 6) += mass * p[kBx];
  by_state(1, 3) -= mass * p[kAy];
  by_state(1, 7) -= mass * p[kBy];
  by_state(2, 4) += mass * p[kTx];
  by_state(3, 5) -= mass * p[kTy];
  by_parameter(0, kAx) = mass * e_th;
  by_parameter(0, kBx) = mass * thd;
  by_parameter(1, kAy) = -mass * e_ph;
  by_parameter(1, kBy) = -mass * phd;
  by_parameter(2, kTx) = mass * xd;
  by_parameter(3, kTy) = -mass * yd;

  const double speed = SmoothNorm(xd, yd);
  by_state(0, 4) -= mass * p[kCq] * (speed + xd * xd / speed);
  by_state(0, 5) -= mass * p[kCq] * xd * yd / speed;
  by_state(1, 4) -= mass * p[kCq] * xd * yd / speed;
  by_state(1, 5) -= mass * p[kCq] * (speed + yd * yd / speed);
  by_parameter(0, kCq) = -mass * speed * xd;
  by_parameter(1, kCq) = -mass * speed * yd;
  const double rate_th = SmoothNorm(thd, 0.0), rate_ph = SmoothNorm(phd, 0.0);
  by_state(2, 6) -= ml2 * p[kDq] * (rate_th + thd * thd / rate_th);
  by_state(3, 7) -= ml2 * p[kDq] * (rate_ph + phd * phd / rate_ph);
  by_parameter(2, kDq) = -ml2 * rate_th * thd;
  by_parameter(3, kDq) = -ml2 * rate_ph * phd;
}

void SelfForce::AddOwnJacobian(const ParameterSet<double>& p, const PendulumState<double>& state,
                               Jacobian* jacobian) const {
  int column = kFirstOwnParameter;
  for (const auto& law : laws) {
    const int own = static_cast<int>(law->parameters().size());
    ForceLaw::Inputs inputs = ForceLaw::Inputs::Zero();
    inputs.head<8>() << state.q, state.qd;
    for (int i = 0; i < own; ++i) inputs[8 + i] = p[column + i];
    ForceLaw::Jacobian by_input;
    law->Force({body, posture}, inputs, &by_input);
    jacobian->by_state += by_input.leftCols<8>();
    jacobian->by_parameter.middleCols(column, own) += by_input.middleCols(8, own);
    column += own;
  }
}

void SelfForce::MotionJacobian(const ParameterSet<double>& p, const PendulumState<double>& state,
                               const Vector4<double>& qd_previous, Jacobian* jacobian) const {
  FrictionJacobian(p, state.qd, jacobian);
  AddBalanceJacobian(p, state, qd_previous, jacobian);
  AddLinearJacobian(p, state, jacobian);
}

void SelfForce::TotalJacobian(const ParameterSet<double>& p, const PendulumState<double>& state,
                              const Vector4<double>& qd_previous, Jacobian* jacobian) const {
  MotionJacobian(p, state, qd_previous, jacobian);
  AddOwnJacobian(p, state, jacobian);
}

}  // namespace pushid
