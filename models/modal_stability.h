// models: the free modes of a person at rest: does a small deviation die out?
//
// Linearized about the upright rest posture the two planes (x, theta) and (y, phi) decouple. With
// e the angle's deviation, v the cart's velocity, w = e', masses M and m, rod l (all sources as in
// self_force.h and ipm.h)
//   (M + K) v' + m l w' = f_v v + f_e e + f_w w
//   m l v' + m l^2 w' = t_v v + t_e e + t_w w
// in the plane (x, theta), and alike in (y, phi) mirrored (phi turns towards -y). t_e is gravity
// less the balance, m g l - Kp; K = Kd of the cart, scaled, acts like a mass (only with a backward
// difference of the cart's velocity, here in the limit of short steps). So d/dt [e, v, w] = A [e,
// v, w]; the cart's own place is a free mode of rate zero and left out, and so are learned terms:
// of a rod that moves (rod_law.h) the length alone has no part in the first order, upright.
#pragma once

#include <Eigen/Core>
#include <array>

#include "models/self_force.h"

namespace pushid {

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

// plane: 0 for (x, theta), 1 for (y, phi). Quadratic damping vanishes at rest.
template <typename T>
ModePolynomial<T> FreeModes(const ModelOptions& options, const Body& body, const ParameterSet<T>& p,
                            int plane) {
  const GainScale scale(options.gain_scaling, body);
  const double mass = body.mass, m = body.point_mass(), l = body.rod_length;
  const bool isotropic = options.friction == FrictionKind::kIsotropic;
  const T mu = plane == 0 || isotropic ? p[kMu] : p[kMuY];
  // The y plane mirrored (phi turns towards -y) obeys the equations of the x plane.
  const T f_v = -scale.force * (mu + p[plane == 0 ? kKpX : kKpY]);
  const T f_e = mass * p[plane == 0 ? kAx : kAy], f_w = mass * p[plane == 0 ? kBx : kBy];
  const T t_v = mass * p[plane == 0 ? kTx : kTy];
  const T t_e = m * kGravity * l - scale.stiffness * p[plane == 0 ? kKpTheta : kKpPhi];
  const T t_w = -scale.damping * p[plane == 0 ? kKdTheta : kKdPhi];
  T inertia = T(mass);
  if (options.cart_derivative == CartDerivative::kBackward) {
    inertia += scale.force * p[plane == 0 ? kKdX : kKdY];
  }
  const T det = inertia * (m * l * l) - m * l * m * l;
  const auto cart = [&](const T& f, const T& t) -> T { return (m * l * l * f - m * l * t) / det; };
  const auto angle = [&](const T& f, const T& t) -> T { return (inertia * t - m * l * f) / det; };
  const T a_e = cart(f_e, t_e), a_v = cart(f_v, t_v), a_w = cart(f_w, t_w);
  const T b_e = angle(f_e, t_e), b_v = angle(f_v, t_v), b_w = angle(f_w, t_w);
  // A = [0 0 1; a_e a_v a_w; b_e b_v b_w] over [e, v, w].
  ModePolynomial<T> polynomial;
  polynomial.c2 = -(a_v + b_w);
  polynomial.c1 = a_v * b_w - a_w * b_v - b_e;
  polynomial.c0 = a_v * b_e - a_e * b_v;
  return polynomial;
}

}  // namespace pushid
