// models: ground that moves: a platform that is shifted or tilted.
//
// The model lives in the ground's frame: q is what the ground sees. With a_g the ground's
// acceleration and gamma its second derivative of tilt, people feel the generalized force
//   -M(q) A - (g_n / g - 1) G(q),   A = [a_gx - g_x, a_gy - g_y, gamma_theta, gamma_phi]
// with g_x, g_y the components of gravity along the ground and g_n that into it: a frame that
// accelerates and one that is tilted cannot be told apart. The ground is turned by R = R_x(phi)
// R_y(theta), as a rod is: g_x = g cos(phi) sin(theta), g_y = -g sin(phi), g_n = g cos(phi)
// cos(theta). gamma acts as about the cart, to first order in the angles.
#pragma once

#include <algorithm>
#include <vector>

#include "models/ipm.h"

namespace pushid {

// Motion of the ground during the step from one frame to the next.
struct GroundStep {
  Vector4<double> acceleration = Vector4<double>::Zero();  // A, m/s^2 and rad/s^2
  double gravity = kGravity;                               // g_n: towards the ground, m/s^2
};

// The place of the ground in the laboratory: m, m; tilt about y and about x as theta and phi are,
// rad.
using GroundPose = Vector4<double>;

// The ground's motion by frame; empty: it does not move.
struct GroundMotion {
  std::vector<GroundPose> poses;  // one per frame
  std::vector<GroundStep> steps;  // one per frame; of the last the one before
  double dt = 0.0;                // s
  GroundStep after;               // of ground that stays where the record ends

  bool moves() const { return !poses.empty(); }
  // The step from any frame: at rest where the ground does not move, or its record is over.
  const GroundStep& StepAt(int frame) const {
    const size_t at = static_cast<size_t>(frame);
    return at < steps.size() ? steps[at] : after;
  }
  // The pose at any frame; the ground must move.
  const GroundPose& PoseAt(int frame) const {
    return poses[std::min(static_cast<size_t>(frame), poses.size() - 1)];
  }
};

// The motion through such poses, frame by frame: its accelerations are those by which semi-implicit
// Euler steps along them, from rest. dt: s.
GroundMotion GroundThrough(std::vector<GroundPose> poses, double dt);

// The frame before the ground leaves its place, by a twentieth of how far it goes: what was
// measured is never quite at rest. As many as there are where it goes nowhere.
int FirstMotion(const std::vector<GroundPose>& poses);

// A state as the laboratory sees it, its rates as those by which semi-implicit Euler comes there:
// from where the laboratory saw it a frame before. origin: below.
PendulumState<double> InLaboratory(const GroundMotion& ground, int frame,
                                   const Vector3<double>& origin,
                                   const PendulumState<double>& state);

// A point of the laboratory as the ground sees it, and back: less its shift, and turned back by its
// tilt about `origin`, where a person stood at frame 0.
Vector3<double> OnGround(const GroundPose& pose, const Vector3<double>& origin,
                         const Vector3<double>& point);
Vector3<double> PointInLaboratory(const GroundPose& pose, const Vector3<double>& origin,
                                  const Vector3<double>& point);

// The force above.
template <typename T, typename L>
Vector4<T> GroundForce(const BodyOf<L>& body, const Angles<T>& angles, const GroundStep& ground) {
  const Vector4<T> a = ground.acceleration.cast<T>();
  return -(MassMatrix<T, L>(body, angles) * a) -
         T(ground.gravity / kGravity - 1.0) * Gravity<T, L>(body, angles);
}

// The ground's reaction to a person who moves: what force platforms measure.
//
// With F = M (a + A) + C + (g_n / g) G - Q_push what the ground and the muscles do to a person at
// frame t (a = (qd(t+1) - qd(t)) / dt; A, g_n: ground.h), h the height of the ankles and F_z the
// vertical force,
//   shear   F_x, F_y
//   centre  p_x = x - (F_theta + h F_x) / F_z,   p_y = y + (F_phi - h F_y) / F_z
// Foot and ground hand on what the ankles ask for
// (Winter, Biomechanics and Motor Control of Human Movement, 2009, section 5.2; feet without mass).

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

// The reaction of the ground to a pendulum that accelerates by a; push: N, N m.
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
