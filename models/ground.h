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

// Of the ground during the step from one frame to the next.
struct GroundStep {
  Vector4<double> acceleration = Vector4<double>::Zero();  // A, m/s^2 and rad/s^2
  double gravity = kGravity;                               // g_n: towards the ground, m/s^2
};

// Where the ground is, in the laboratory: m, m; tilt about y and about x as theta and phi are, rad.
using GroundPose = Vector4<double>;

// Empty: ground that does not move.
struct GroundMotion {
  std::vector<GroundPose> poses;  // one per frame
  std::vector<GroundStep> steps;  // one per frame; of the last the one before
  double dt = 0.0;                // s
  GroundStep after;               // of ground that stays where the record ends

  bool moves() const { return !poses.empty(); }
  // Of any frame: at rest where the ground does not move, or its record is over.
  const GroundStep& StepAt(int frame) const {
    const size_t at = static_cast<size_t>(frame);
    return at < steps.size() ? steps[at] : after;
  }
  // The same; of ground that moves.
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

}  // namespace pushid
