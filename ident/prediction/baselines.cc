// ident: static, constant velocity and kinematic predictions.
#include <algorithm>

#include "ident/observed/first_frames.h"
#include "ident/prediction/evaluation.h"

namespace pushid {
namespace {

constexpr int kLeastPredicted = 10;  // frames

// A push may last as long as its recording: something must be left to predict.
int LastKnown(const PendulumRecording& recording, int observed) {
  const int frames = recording.num_frames();
  const int latest = std::max(frames / 2, frames - 1 - kLeastPredicted);
  const int known = observed > 0 ? observed - 1 : std::min(recording.scene.LastPushEnd(), latest);
  return std::min(known, frames - 1);
}

// What is known as it was, and then what `ahead` says of it.
template <typename Ahead>
HipPaths Continued(const PendulumRecording& recording, int observed, const Ahead& ahead) {
  const int known = LastKnown(recording, observed) + 1;
  HipPaths paths;
  for (int n = 0; n < recording.num_people(); ++n) {
    const auto& hip = recording.hip[n];
    SeenPath seen{HipPath(hip.begin(), hip.begin() + known), {}};
    for (int t = 0; t < known; ++t) seen.seen.push_back(t == 0 || recording.Weight(n, t) > 0.0);
    const HipPath rest = ahead(seen, recording.num_frames() - known);
    paths.push_back(std::move(seen.hip));
    paths.back().insert(paths.back().end(), rest.begin(), rest.end());
  }
  return paths;
}

HipPaths VelocityBaseline(const PendulumRecording& recording, int observed, int frames) {
  const double dt = recording.scene.dt;
  return Continued(recording, observed, [&](const SeenPath& seen, int ahead) {
    return GoesOn(seen, frames * dt, dt, ahead);
  });
}

}  // namespace

HipPaths StaticBaseline(const PendulumRecording& recording, int observed) {
  HipPaths paths;
  for (const auto& hip : recording.hip) {
    HipPath path(hip.begin(), hip.begin() + std::max(1, observed));
    path.resize(hip.size(), Vector3<double>(path.back()));
    paths.push_back(std::move(path));
  }
  return paths;
}

HipPaths ConstantVelocityBaseline(const PendulumRecording& recording, int observed) {
  return VelocityBaseline(recording, observed, 1);
}

HipPaths VelocityOfThreeBaseline(const PendulumRecording& recording, int observed) {
  return VelocityBaseline(recording, observed, 3);
}

HipPaths VelocityOfEightBaseline(const PendulumRecording& recording, int observed) {
  return VelocityBaseline(recording, observed, 8);
}

HipPaths KinematicBaseline(const PendulumRecording& recording, int observed) {
  return Continued(recording, observed, [&](const SeenPath& seen, int ahead) {
    return GoesOnAccelerating(seen, recording.scene.dt, ahead);
  });
}

}  // namespace pushid
