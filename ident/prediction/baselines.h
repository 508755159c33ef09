// ident: predictions that ask no model.
#pragma once

#include "datasets/loading/pendulum_recording.h"
#include "ident/model/model_rollout.h"

namespace pushid {

// observed: frames seen first, frame 0 among them; 0: until the last push ends, or the last frame
// but ten (half of a short recording); of the static one frame 0 alone.
HipPaths StaticBaseline(const PendulumRecording& recording, int observed = 0);
// On with the velocity of the last frame, or the mean of the last three or eight.
HipPaths ConstantVelocityBaseline(const PendulumRecording& recording, int observed = 0);
HipPaths VelocityOfThreeBaseline(const PendulumRecording& recording, int observed = 0);
HipPaths VelocityOfEightBaseline(const PendulumRecording& recording, int observed = 0);
// GoesOnAccelerating (observed/kinematics.h).
HipPaths KinematicBaseline(const PendulumRecording& recording, int observed = 0);

struct Baseline {
  const char* name;
  const char* key;  // in files
  HipPaths (*predict)(const PendulumRecording&, int observed);
  bool needs_frames;  // only where first frames were seen
};
inline constexpr Baseline kBaselines[] = {
    {"static", "static", StaticBaseline, false},
    {"constant velocity", "constant_velocity", ConstantVelocityBaseline, false},
    {"velocity of 3 frames", "velocity_of_3", VelocityOfThreeBaseline, true},
    {"velocity of 8 frames", "velocity_of_8", VelocityOfEightBaseline, true},
    {"kinematic", "kinematic", KinematicBaseline, true},
};

}  // namespace pushid
