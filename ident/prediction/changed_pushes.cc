// ident: pushes of a scene, scaled and repeated.
#include <algorithm>
#include <cmath>

#include "datasets/files/number_text.h"
#include "ident/prediction/prediction.h"

namespace pushid {
namespace {

int FirstPushStart(const Scene& scene) {
  int start = scene.pushes.front().start_frame;
  for (const ScenePush& push : scene.pushes) start = std::min(start, push.start_frame);
  return start;
}

MaybeError CheckAgain(const std::vector<int>& again, const Scene& scene, int frames) {
  const int length = scene.LastPushEnd() - FirstPushStart(scene);
  int end = scene.LastPushEnd();
  for (int frame : again) {
    const std::string start = "--push_again: frame " + std::to_string(frame);
    if (frame < 0) return Error{start + " is negative; frames count from 0"};
    if (frame < end) {
      return Error{start +
                   " comes before the push before it has ended; pushes must not overlap, and stand "
                   "in ascending order: " +
                   "give frame " + std::to_string(end) + " or a later one"};
    }
    // Row t drives the step from frame t to t + 1.
    if (frame > frames - 2) {
      return Error{start + " is too late for the " + std::to_string(frames) +
                   " frames that are predicted; give an earlier one, or more --frames"};
    }
    end = frame + length;
  }
  return std::nullopt;
}

}  // namespace

MaybeError CheckChangedPushes(const ChangedPushes& changed, const PendulumRecording& recording,
                              int frames) {
  if (!(changed.scale > 0.0) || !std::isfinite(changed.scale)) {
    return Error{"--push_scale is " + Rounded(changed.scale, 3) +
                 "; it must be a positive number, as in 1.37"};
  }
  if (changed.Any() && recording.scene.pushes.empty()) {
    return Error{"recording " + recording.id +
                 " has no push: leave out --push_scale and --push_again"};
  }
  if (changed.again.empty()) return std::nullopt;
  return CheckAgain(changed.again, recording.scene, frames);
}

PendulumRecording WithPushes(PendulumRecording recording, const ChangedPushes& changed) {
  if (changed.scale != 1.0) recording.scene = ScalePushes(recording.scene, changed.scale);
  const std::vector<ScenePush> pushes = recording.scene.pushes;
  for (int frame : changed.again) {
    const int later = frame - FirstPushStart(recording.scene);
    for (ScenePush push : pushes) {
      push.start_frame += later;
      recording.scene.pushes.push_back(std::move(push));
    }
  }
  return recording;
}

std::string ChangedPushesText(const ChangedPushes& changed, const PendulumRecording& recording) {
  std::string text = changed.scale == 1.0 ? "" : Rounded(changed.scale, 4) + " times ";
  text += "the recorded push";
  if (changed.again.empty()) return text;
  text += ", at frames " + std::to_string(FirstPushStart(recording.scene));
  for (int frame : changed.again) {
    text += (frame == changed.again.back() ? " and " : ", ") + std::to_string(frame);
  }
  return text;
}

}  // namespace pushid
