// models: the forces on a person at rest, linearized: does a small deviation die out
// (ident/problem/behaviour.h), and what are the margins of the loop (ident/problem/linear_loop.h)?
//
// The forces of the rollout (self_force.h) and gravity (ipm.h) are linearized about rest by dual
// numbers; nothing of them is written again here. Where feet stand (stance.h) or hold (standing.h)
// rest is standing: the ankles balance, and the ground resists the cart.
#pragma once

#include <Eigen/Core>

#include "models/dual.h"
#include "models/stance.h"
#include "models/standing.h"

namespace pushid {

// First derivatives, at rest in the reference posture, of the self force less gravity.
struct RestJacobian {
  Eigen::Matrix<double, 4, 6> by_state;  // over [theta, phi, qd]
  Eigen::Vector2d by_previous;           // diagonal: cart rows by the cart's velocity a step before
  double ground = 0.0;  // N s/m, on the cart's velocity after a step, where feet stand
};

// The pendulum that a person is at rest.
template <typename T>
BodyOf<T> BodyAtRest(const ModelOptions& options, const Body& body, const ParameterSet<T>& p) {
  return DynamicBody(options, body, p, options.stance == Stance::kFixed);
}

// The self force near rest: that of sliding feet, or of feet that stand.
template <typename T>
Vector4<T> ForceNearRest(Stance stance, const SelfForce& self, const ParameterSet<T>& p,
                         const PendulumState<T>& state, const Perceived<T>& perceived,
                         const Vector4<T>& previous) {
  Vector4<T> force = self.Own(p, state);
  if (stance == Stance::kSlide) {
    const Vector4<T> of_cart =
        self.Balance(p, perceived.step, previous) + self.Linear(p, perceived.step);
    const Vector4<T> of_angles =
        self.Balance(p, perceived.ankle, previous) + self.Linear(p, perceived.ankle);
    force += self.Friction(p, state.qd);
    force.template head<2>() += of_cart.template head<2>();
    force.template tail<2>() += of_angles.template tail<2>();
  } else if (stance == Stance::kSteps) {
    FeetState<T> feet;
    for (int i = 0; i < 2; ++i) feet.apart[i] = T(self.standing.apart[i]);
    force.template tail<2>() +=
        StanceAt<T>(self.standing, StanceParameters<T>(p), feet, perceived.ankle, perceived.step)
            .torque;
  } else {
    force.template tail<2>() +=
        StandingTorque(self, p, Angles<T>(perceived.ankle.q), perceived.ankle.qd);
  }
  return force;
}

// Derivatives by what: by the state with all that is perceived of it at once, as without a delay;
// or by each alone.
enum class RestInput { kAll, kState, kAnkle, kStep };

inline RestJacobian LinearizeAtRest(const ModelOptions& options, const SelfForce& self,
                                    const ParameterSet<double>& p, RestInput by = RestInput::kAll) {
  const Stance stance = options.stance;
  using RestDual = Dual<double, 8>;
  ParameterSet<RestDual> parameters;
  for (int i = 0; i < kNumParameters; ++i) parameters[i] = RestDual::Constant(p[i]);
  PendulumState<RestDual> moved, rest;
  Vector4<RestDual> previous;
  for (int i = 0; i < 4; ++i) moved.qd[i] = RestDual::Input(0.0, 2 + i);
  for (int i = 0; i < 2; ++i) {
    moved.q[2 + i] = RestDual::Input(self.posture[i], i);
    rest.q[2 + i] = RestDual(self.posture[i]);
    previous[i] = RestDual::Input(0.0, 6 + i);
  }
  const auto input = [&](RestInput own) -> const PendulumState<RestDual>& {
    return by == RestInput::kAll || by == own ? moved : rest;
  };
  const PendulumState<RestDual>& state = input(RestInput::kState);
  Perceived<RestDual> perceived;
  perceived.ankle = input(RestInput::kAnkle);
  perceived.step = input(RestInput::kStep);
  const Vector4<RestDual> force =
      ForceNearRest(stance, self, parameters, state, perceived, previous) -
      Gravity<RestDual>(BodyAtRest(options, self.body, parameters), state.q);
  RestJacobian jacobian;
  if (stance != Stance::kSlide) jacobian.ground = kHeldFast * self.body.mass;
  for (int row = 0; row < 4; ++row) {
    jacobian.by_state.row(row) = force[row].v.head<6>().transpose();
  }
  for (int i = 0; i < 2; ++i) jacobian.by_previous[i] = force[i].v[6 + i];
  return jacobian;
}

}  // namespace pushid
