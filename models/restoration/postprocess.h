// models: post-processing, which fits a restored motion to the person and the floor.
//
//   1. The residual at frame 0 (restored pose - first pose) is subtracted and fades over 8 frames,
//      so that the motion begins with the first pose. If several frames were observed, they replace
//      the restored ones, and the residual is that of the last of them.
//   2. The pose is transferred to the person's own skeleton (FitSkeleton of body.h), so that bones
//      keep their length.
//   3. Feet are locked: an ankle that is low and slow stays where it came to rest, by two-bone
//      inverse kinematics; when it leaves, the correction fades over 4 frames. If the model
//      predicts feet (RestorationInput::feet), PlantFeet moves the feet there instead, unless
//      several frames were observed.
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

// now: the last observed frame, after which frames are changed; `pose`: the one observed there. A
// foot that moves or is off the ground at `now` is not locked; at frame 0 both feet stand.
void FadeResidual(const Pose& pose, int frames, BodyMotion* motion, int now = 0);
void KeepBones(const Pose& first_pose, BodyMotion* motion, int now = 0);
void LockFeet(const Pose& first_pose, double dt, const PostprocessOptions& options,
              BodyMotion* motion, int now = 0);

// Applies the steps that the options select, in this order.
void Finish(const RestorationInput& person, const PostprocessOptions& options, BodyMotion* motion);

// Moves each foot to where the model predicts it (person.feet, an entry for each frame). A standing
// foot keeps its pose of frame 0. A foot in the air has the height (at least 5 cm) and the pitch of
// the restored foot, both of which fade towards lift-off and landing. A leg that is too short
// reaches as far as it can.
void PlantFeet(const RestorationInput& person, BodyMotion* motion);

}  // namespace pushid
