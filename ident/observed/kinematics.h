// ident: hips that go on as they were seen to go, without any model.
#pragma once

#include <vector>

#include "ident/model/model_rollout.h"

namespace pushid {

// What was seen of one hip, frame 0 at least; unseen frames are ignored.
struct SeenPath {
  HipPath hip;
  std::vector<bool> seen;
};
int LastSeen(const SeenPath& path);

// From the last frame on: where it was seen last, and on with the mean velocity of so many seconds
// before (one frame at least). One frame alone stays where it is.
HipPath GoesOn(const SeenPath& path, double seconds, double dt, int frames_ahead);

// A quadratic through the last 0.23 s, whose acceleration fades with 0.25 s and whose velocity with
// 1 s.
HipPath GoesOnAccelerating(const SeenPath& path, double dt, int frames_ahead);

}  // namespace pushid
