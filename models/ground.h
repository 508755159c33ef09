// models: moving ground: a platform that is shifted or tilted.
//
// The state q is in the ground's frame. With a_g the ground's acceleration and gamma the second
// derivative of its tilt, the generalized force on a person is
//   -M(q) A - (g_n / g - 1) G(q),   A = [a_gx - g_x, a_gy - g_y, gamma_theta, gamma_phi]
// with g_x, g_y the components of gravity along the ground and g_n that into it: acceleration and
// tilt of a frame are equivalent. The ground is turned by R = R_x(phi) R_y(theta), as a rod is: g_x
// = g cos(phi) sin(theta), g_y = -g sin(phi), g_n = g cos(phi) cos(theta). gamma acts as about the
// cart, to first order in the angles.
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

// The place of the ground in the laboratory: x, y (m) and the tilts about y and x, defined like
// theta and phi (rad).
using GroundPose = Vector4<double>;

// The ground's motion by frame; empty: it does not move.
struct GroundMotion {
  std::vector<GroundPose> poses;  // one per frame
  std::vector<GroundStep> steps;  // one per frame; the last repeats the one before
  double dt = 0.0;                // s
  GroundStep after;               // after the end of the record, where the ground rests

  bool moves() const { return !poses.empty(); }
  // The step from any frame; at rest if the ground does not move or its record has ended.
  const GroundStep& StepAt(int frame) const {
    const size_t at = static_cast<size_t>(frame);
    return at < steps.size() ? steps[at] : after;
  }
  // The pose at any frame; the ground must move.
  const GroundPose& PoseAt(int frame) const {
    return poses[std::min(static_cast<size_t>(frame), poses.size() - 1)];
  }
};

// The motion through poses, frame by frame: semi-implicit Euler with its accelerations reproduces
// the poses, from rest. dt: s.
GroundMotion GroundThrough(std::vector<GroundPose> poses, double dt);

// The last frame before the ground has moved by a twentieth of its largest displacement (measured
// ground is never exactly at rest); the number of frames if it does not move.
int FirstMotion(const std::vector<GroundPose>& poses);

// A state in the laboratory's frame; its rates are the differences from the previous frame's place
// in the laboratory, as in semi-implicit Euler. origin: as below.
PendulumState<double> InLaboratory(const GroundMotion& ground, int frame,
                                   const Vector3<double>& origin,
                                   const PendulumState<double>& state);

// A point from the laboratory's frame to the ground's, and back: the shift is subtracted, and the
// tilt about `origin`, the person's place at frame 0, is undone.
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
