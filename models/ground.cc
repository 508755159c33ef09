// models: ground that moves.
#include "models/ground.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace pushid {

GroundMotion GroundThrough(std::vector<GroundPose> poses, double dt) {
  GroundMotion ground;
  const int frames = static_cast<int>(poses.size());
  for (int t = 0; t < frames; ++t) {
    GroundStep step;
    if (frames > 1) {
      // Of the last frame no step is taken; at the first the ground was at rest.
      const int at = std::min(t, frames - 2);
      const GroundPose& before = poses[std::max(at - 1, 0)];
      step.acceleration = (poses[at + 1] - 2.0 * poses[at] + before) / (dt * dt);
    }
    // Of a frame turned by theta about y and phi about x: gravity along its axes.
    const double theta = poses[t][2], phi = poses[t][3];
    step.acceleration[0] -= kGravity * std::sin(theta);
    step.acceleration[1] += kGravity * std::cos(theta) * std::sin(phi);
    step.gravity = kGravity * std::cos(theta) * std::cos(phi);
    ground.steps.push_back(step);
  }
  ground.dt = dt;
  ground.poses = std::move(poses);
  return ground;
}

namespace {

Eigen::Matrix3d Tilt(const GroundPose& pose) {
  return (Eigen::AngleAxisd(pose[3], Vector3<double>::UnitX()) *
          Eigen::AngleAxisd(pose[2], Vector3<double>::UnitY()))
      .toRotationMatrix();
}

}  // namespace

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
                                   PendulumState<double> state) {
  if (!ground.moves()) return state;
  state.q += ground.poses[frame];
  if (frame > 0) state.qd += (ground.poses[frame] - ground.poses[frame - 1]) / ground.dt;
  return state;
}

}  // namespace pushid
