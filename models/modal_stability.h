// models: the free modes of a person at rest: does a small deviation die out?
//
// The forces of the rollout (self_force.h) and gravity (ipm.h) are linearized about rest by dual
// numbers; nothing of them is written again here. About the upright posture the two planes
// (x, theta) and (y, phi) decouple. With e the angle's deviation, v the cart's velocity, w = e',
//   (m_xx + K) v' + m_xe w' = f_v v + f_e e + f_w w
//   m_xe v' + m_ee w' = t_v v + t_e e + t_w w
// where m_.. are elements of the mass matrix, f and t the derivatives of the forces less gravity,
// and K = -d F / d v', which only a backward difference of the cart's velocity has, here in the
// limit of short steps. So d/dt [e, v, w] = A [e, v, w]; the cart's own place is a free mode of
// rate zero and left out, and so are learned terms: of a rod that moves (learned_terms.h) the
// length alone has no part in the first order, upright. A user's own law (force_law.h) that couples
// the planes does so in behaviour.h, not here, and so does a reaction delay, by a step that
// remembers. Where feet stand (stance.h) or hold (standing.h)
// rest is standing: the ankles balance, and the ground resists the cart.
#pragma once

#include <Eigen/Core>
#include <array>

#include "models/dual.h"
#include "models/stance.h"
#include "models/standing.h"

namespace pushid {

// First derivatives, at rest in the reference posture, of the self force less gravity.
template <typename T>
struct RestJacobian {
  Eigen::Matrix<T, 4, 6> by_state;     // over [theta, phi, qd]
  Eigen::Matrix<T, 2, 1> by_previous;  // diagonal: cart rows by the cart's velocity a step before
  T ground = T(0.0);  // N s/m, on the cart's velocity after a step, where feet stand
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

template <typename T>
RestJacobian<T> LinearizeAtRest(const ModelOptions& options, const SelfForce& self,
                                const ParameterSet<T>& p, RestInput by = RestInput::kAll) {
  const Stance stance = options.stance;
  using RestDual = Dual<T, 8>;
  ParameterSet<RestDual> parameters;
  for (int i = 0; i < kNumParameters; ++i) parameters[i] = RestDual::Constant(p[i]);
  PendulumState<RestDual> moved, rest;
  Vector4<RestDual> previous;
  for (int i = 0; i < 4; ++i) moved.qd[i] = RestDual::Input(T(0.0), 2 + i);
  for (int i = 0; i < 2; ++i) {
    moved.q[2 + i] = RestDual::Input(T(self.posture[i]), i);
    rest.q[2 + i] = RestDual(self.posture[i]);
    previous[i] = RestDual::Input(T(0.0), 6 + i);
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
  RestJacobian<T> jacobian;
  if (stance != Stance::kSlide) jacobian.ground = T(kHeldFast * self.body.mass);
  for (int row = 0; row < 4; ++row) {
    jacobian.by_state.row(row) = force[row].v.template head<6>().transpose();
  }
  for (int i = 0; i < 2; ++i) jacobian.by_previous[i] = force[i].v[6 + i];
  return jacobian;
}

// The characteristic polynomial lambda^3 + c2 lambda^2 + c1 lambda + c0 of one plane's A, in 1/s.
template <typename T>
struct ModePolynomial {
  T c2, c1, c0;

  // The polynomial of the modes' rates plus `margin`: its roots all lie left of zero exactly when
  // those of this one all lie left of -margin.
  ModePolynomial Shifted(double margin) const {
    const double s = margin;
    return {c2 - 3.0 * s, c1 - 2.0 * s * c2 + 3.0 * s * s, c0 - s * c1 + s * s * c2 - s * s * s};
  }
  // Routh and Hurwitz: all modes decay when all three are positive.
  std::array<T, 3> Conditions() const { return {c2, c0, c2 * c1 - c0}; }
};

// A person who stands upright at rest, linearized.
template <typename T>
struct UprightRest {
  static constexpr double kStep = 1.0;  // s; any: what follows does not depend on it
  BodyOf<T> body;
  RestJacobian<T> jacobian;

  UprightRest(const ModelOptions& options, const Body& person, const ParameterSet<T>& p)
      : body(BodyAtRest(options, person, p)) {
    // Quadratic damping vanishes at rest: the floor under its norm, there for the rollout's
    // derivatives, is nothing to rely on.
    ParameterSet<T> linear = p;
    linear[kCq] = linear[kDq] = T(0.0);
    const SelfForce self(options, person, Vector4<double>::Zero(), kStep);
    jacobian = LinearizeAtRest(options, self, linear);
  }
};

// plane: 0 for (x, theta), 1 for (y, phi).
template <typename T>
ModePolynomial<T> FreeModes(const UprightRest<T>& upright, int plane) {
  const BodyOf<T>& body = upright.body;
  const RestJacobian<T>& rest = upright.jacobian;
  const Matrix4<T> mass = MassMatrix<T>(body, Angles<T>());
  const int cart = plane, angle = 2 + plane;                   // rows
  const int at_e = plane, at_v = 2 + plane, at_w = 4 + plane;  // columns
  const T k = UprightRest<T>::kStep * rest.by_previous[plane];
  const T f_e = rest.by_state(cart, at_e), f_w = rest.by_state(cart, at_w);
  const T f_v = rest.by_state(cart, at_v) + rest.by_previous[plane] - rest.ground;
  const T t_e = rest.by_state(angle, at_e), t_v = rest.by_state(angle, at_v);
  const T t_w = rest.by_state(angle, at_w);
  const T m_xe = mass(cart, angle), m_ee = mass(angle, angle);
  const T m_xx = mass(cart, cart) + k;
  const T det = m_xx * m_ee - m_xe * m_xe;
  const auto of_cart = [&](const T& f, const T& t) -> T { return (m_ee * f - m_xe * t) / det; };
  const auto of_angle = [&](const T& f, const T& t) -> T { return (m_xx * t - m_xe * f) / det; };
  const T a_e = of_cart(f_e, t_e), a_v = of_cart(f_v, t_v), a_w = of_cart(f_w, t_w);
  const T b_e = of_angle(f_e, t_e), b_v = of_angle(f_v, t_v), b_w = of_angle(f_w, t_w);
  // A = [0 0 1; a_e a_v a_w; b_e b_v b_w] over [e, v, w].
  ModePolynomial<T> polynomial;
  polynomial.c2 = -(a_v + b_w);
  polynomial.c1 = a_v * b_w - a_w * b_v - b_e;
  polynomial.c0 = a_v * b_e - a_e * b_v;
  return polynomial;
}

}  // namespace pushid
