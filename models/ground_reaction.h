// models: what the ground does to a person who moves: what force platforms measure.
//
// With F = M (a + A) + C + (g_n / g) G - Q_push what the ground and the muscles do to a person at
// frame t (a = (qd(t+1) - qd(t)) / dt; A, g_n: ground.h), h the height of the ankles and F_z the
// vertical force,
//   shear   F_x, F_y
//   centre  p_x = x - (F_theta + h F_x) / F_z,   p_y = y + (F_phi - h F_y) / F_z
// Foot and ground hand on what the ankles ask for
// (Winter, Biomechanics and Motor Control of Human Movement, 2009, section 5.2; feet without mass).
#pragma once

#include "models/ground.h"
#include "models/ipm.h"

namespace pushid {

// F and F_z of a pendulum that feels the acceleration a + A and the gravity g_n.
template <typename T>
struct ReactionForce {
  Vector4<T> force;  // N, N, N m, N m
  T vertical;        // N

  ReactionForce(const BodyOf<T>& body, const Angles<T>& angles, const Vector4<T>& qd,
                const Vector4<T>& felt, double gravity, const Vector4<T>& push)
      : force(MassMatrix(body, angles) * felt + Coriolis(body, angles, qd) +
              T(gravity / kGravity) * Gravity(body, angles) - push) {
    const auto& [s_th, c_th, s_ph, c_ph] = angles;
    const T& thd = qd[2];
    const T& phd = qd[3];
    const T rise = -(c_th * c_ph) * (thd * thd + phd * phd) + 2.0 * s_th * s_ph * thd * phd -
                   s_th * c_ph * felt[2] - c_th * s_ph * felt[3];
    vertical = body.mass * T(gravity) + body.point_mass() * body.pendulum_length() * rise;
  }
};

// [F_x, F_y, p_x, p_y], N and m.
template <typename T>
using GroundReactionOf = Eigen::Matrix<T, 4, 1>;

template <typename T>
GroundReactionOf<T> ReactionOn(const ReactionForce<T>& of, const T& height, const Vector4<T>& q) {
  return {of.force[0], of.force[1], q[0] - (of.force[2] + height * of.force[0]) / of.vertical,
          q[1] + (of.force[3] - height * of.force[1]) / of.vertical};
}

// For a pendulum that accelerates so; push: N, N m.
template <typename T>
GroundReactionOf<T> GroundReaction(const BodyOf<T>& body, const PendulumState<T>& state,
                                   const Vector4<T>& a, const GroundStep& ground,
                                   const Vector4<T>& push) {
  const Vector4<T> felt = a + ground.acceleration.cast<T>();
  return ReactionOn(
      ReactionForce<T>(body, Angles<T>(state.q), state.qd, felt, ground.gravity, push),
      body.cart_height, state.q);
}

}  // namespace pushid
