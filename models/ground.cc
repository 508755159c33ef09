// models: ground that moves.
#include "models/ground.h"

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

PendulumState<double> InLaboratory(const GroundMotion& ground, int frame,
                                   PendulumState<double> state) {
  if (!ground.moves()) return state;
  state.q += ground.poses[frame];
  if (frame > 0) state.qd += (ground.poses[frame] - ground.poses[frame - 1]) / ground.dt;
  return state;
}

}  // namespace pushid
