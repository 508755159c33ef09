// models: what makes a restored motion fit the person and the floor, for every kind of restoration.
//
//   1. The residual at frame 0 (restored pose - first pose) is taken off, fading over 8 frames: the
//      motion begins where the person stands. Where more frames were seen, they are in the motion
//      as they were, and all that follows begins with the last of them.
//   2. The person's own skeleton carries it out (FitSkeleton of body.h): bones keep their length.
//   3. Feet are locked: while an ankle is low and slow it stays where it came to rest, by two-bone
//      inverse kinematics; when it leaves, the correction fades over 4 frames. Where the model
//      has feet (RestorationInput::feet), they are where these are (PlantFeet, below), unless more
//      than one frame was seen: these know better.
#pragma once

#include "models/restoration/restoration.h"

namespace pushid {

struct PostprocessOptions {
  bool fade_residual = true;
  int fade_frames = 8;
  bool keep_bones = true;
  bool lock_feet = true;
  double contact_height = 0.025;  // m above the ankle's own height at frame 0
  double contact_speed = 0.5;     // m/s, horizontal: slower is standing
  double release_drift = 0.10;    // m: a lock that would pull further than this lets go
  int release_frames = 4;
  double out_of_reach = 0.005;  // m by which a leg may miss the place that it stands on
};

// now: the frame from which on; `pose` is what was seen there. Feet that move or are off the ground
// then are not locked; at frame 0 people stand.
void FadeResidual(const Pose& pose, int frames, BodyMotion* motion, int now = 0);
void KeepBones(const Pose& first_pose, BodyMotion* motion, int now = 0);
void LockFeet(const Pose& first_pose, double dt, const PostprocessOptions& options,
              BodyMotion* motion, int now = 0);

// All that the options ask for, in this order.
void Finish(const RestorationInput& person, const PostprocessOptions& options, BodyMotion* motion);

// Only the feet, where the model has some: each is where its own is, moved from frame 0. One that
// stands is as it was at frame 0; one in the air is as high as the restoration has it, 5 cm at
// least, and pitches as there, both fading towards lift-off and landing. A leg that is too short
// reaches as far as it can. person.feet has an entry for each frame of the motion.
void PlantFeet(const RestorationInput& person, BodyMotion* motion);

}  // namespace pushid
