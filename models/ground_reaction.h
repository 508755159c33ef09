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

// [F_x, F_y, p_x, p_y], N and m.
template <typename T>
using GroundReactionOf = Eigen::Matrix<T, 4, 1>;

// [F_x, F_y, p_x, p_y] for a pendulum that accelerates so; push: N, N m.
template <typename T>
GroundReactionOf<T> GroundReaction(const BodyOf<T>& body, const PendulumState<T>& state,
                                   const Vector4<T>& a, const GroundStep& ground,
                                   const Vector4<T>& push) {
  const Angles<T> angles(state.q);
  const auto& [s_th, c_th, s_ph, c_ph] = angles;
  const Vector4<T> felt = a + ground.acceleration.cast<T>();
  const Vector4<T> force = MassMatrix<T, T>(body, angles) * felt +
                           Coriolis<T, T>(body, angles, state.qd) +
                           T(ground.gravity / kGravity) * Gravity<T, T>(body, angles) - push;
  const T thd = state.qd[2], phd = state.qd[3];
  const T rise = -(c_th * c_ph) * (thd * thd + phd * phd) + 2.0 * s_th * s_ph * thd * phd -
                 s_th * c_ph * felt[2] - c_th * s_ph * felt[3];
  const T vertical =
      body.mass * T(ground.gravity) + body.point_mass() * body.pendulum_length() * rise;
  const T& h = body.cart_height;
  return {force[0], force[1], state.q[0] - (force[2] + h * force[0]) / vertical,
          state.q[1] + (force[3] - h * force[1]) / vertical};
}

}  // namespace pushid
