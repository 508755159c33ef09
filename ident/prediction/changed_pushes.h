// ident: what if a recording's people were pushed harder, or again?
//
//   ChangedPushes changed;
//   changed.scale = 1.37;      // every force and torque times so much
//   changed.again = {40, 80};  // the push comes three times
//   if (MaybeError error = CheckChangedPushes(changed, recording, frames)) ...
//   Predict(model, WithPushes(recording, changed), frames);
//
// A push that comes again is the recorded one, on the same person at the same height, and starts at
// that frame; of several pushes, all come again at their distances. The recorded motion is no
// reference for what follows.
#pragma once

#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/loading/pendulum_recording.h"

namespace pushid {

struct ChangedPushes {
  double scale = 1.0;
  std::vector<int> again;  // frames, ascending

  bool Any() const { return scale != 1.0 || !again.empty(); }
};

// The options are named --push_scale and --push_again. frames: how many are predicted. Errors: a
// scale that is not positive; nothing to change; a push that begins before the one before it has
// ended (a net force says nothing of two at once), or after the prediction.
MaybeError CheckChangedPushes(const ChangedPushes& changed, const PendulumRecording& recording,
                              int frames);

// Everything but the pushes stays, the recorded motion too.
PendulumRecording WithPushes(PendulumRecording recording, const ChangedPushes& changed);

// "1.37 times the recorded push, at frames 0, 40 and 80".
std::string ChangedPushesText(const ChangedPushes& changed, const PendulumRecording& recording);

}  // namespace pushid
