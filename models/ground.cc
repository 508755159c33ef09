// models: ground that moves.
#include "models/ground.h"

#include <Eigen/Geometry>
#include <cmath>

namespace pushid {
namespace {

Eigen::Matrix3d Tilt(const GroundPose& pose) {
  return (Eigen::AngleAxisd(pose[3], Vector3<double>::UnitX()) *
          Eigen::AngleAxisd(pose[2], Vector3<double>::UnitY()))
      .toRotationMatrix();
}

// A step of ground that rests there: gravity along its axes.
GroundStep Still(const GroundPose& pose) {
  const Vector3<double> gravity = -kGravity * Tilt(pose).row(2).transpose();
  GroundStep step;
  step.acceleration.head<2>() = -gravity.head<2>();
  step.gravity = -gravity[2];
  return step;
}

// q as the laboratory sees it.
Vector4<double> PlaceInLaboratory(const GroundPose& pose, const Vector3<double>& origin,
                                  const Vector4<double>& q) {
  const Vector3<double> cart = PointInLaboratory(pose, origin, {q[0], q[1], origin[2]});
  const Angles<double> angles(q);
  const Vector3<double> along =
      Tilt(pose) *
      Vector3<double>(angles.s_th, -angles.c_th * angles.s_ph, angles.c_th * angles.c_ph);
  return {cart[0], cart[1], std::asin(std::clamp(along[0], -1.0, 1.0)),
          std::atan2(-along[1], along[2])};
}

}  // namespace

GroundMotion GroundThrough(std::vector<GroundPose> poses, double dt) {
  GroundMotion ground;
  const int frames = static_cast<int>(poses.size());
  for (int t = 0; t < frames; ++t) {
    GroundStep step;
    if (frames > 1) {
      // No step is taken from the last frame; at the first the ground was at rest.
      const int at = std::min(t, frames - 2);
      const GroundPose& before = poses[std::max(at - 1, 0)];
      step.acceleration = (poses[at + 1] - 2.0 * poses[at] + before) / (dt * dt);
    }
    const GroundStep still = Still(poses[t]);
    step.acceleration += still.acceleration;
    step.gravity = still.gravity;
    ground.steps.push_back(step);
  }
  if (frames > 0) ground.after = Still(poses.back());
  ground.dt = dt;
  ground.poses = std::move(poses);
  return ground;
}

int FirstMotion(const std::vector<GroundPose>& poses) {
  constexpr double kLeft = 0.05;
  double farthest = 0.0;
  for (const GroundPose& pose : poses) farthest = std::max(farthest, (pose - poses[0]).norm());
  const int frames = static_cast<int>(poses.size());
  for (int t = 1; t < frames; ++t) {
    if ((poses[t] - poses[0]).norm() > kLeft * farthest) return t - 1;
  }
  return frames;
}

Vector3<double> OnGround(const GroundPose& pose, const Vector3<double>& origin,
                         const Vector3<double>& point) {
  const Vector3<double> shift(pose[0], pose[1], 0.0);
  return origin + Tilt(pose).transpose() * (point - origin - shift);
}

Vector3<double> PointInLaboratory(const GroundPose& pose, const Vector3<double>& origin,
                                  const Vector3<double>& point) {
  return origin + Vector3<double>(pose[0], pose[1], 0.0) + Tilt(pose) * (point - origin);
}

PendulumState<double> InLaboratory(const GroundMotion& ground, int frame,
                                   const Vector3<double>& origin,
                                   const PendulumState<double>& state) {
  if (!ground.moves()) return state;
  const Vector4<double> before = PlaceInLaboratory(ground.PoseAt(std::max(frame - 1, 0)), origin,
                                                   state.q - ground.dt * state.qd);
  PendulumState<double> seen = state;
  seen.q = PlaceInLaboratory(ground.PoseAt(frame), origin, state.q);
  seen.qd = (seen.q - before) / ground.dt;
  return seen;
}

}  // namespace pushid
