// ident: groups of pendulums compared.
#include "ident/validation/hip_group_metrics.h"

#include <set>

namespace pushid {
namespace {

// First poses carried by hips.
std::vector<BodyMotion> Carried(const std::vector<BodyMotion>& recorded, const HipPaths& hips) {
  std::vector<BodyMotion> carried;
  for (size_t n = 0; n < recorded.size(); ++n) {
    const Pose& first = recorded[n].front();
    BodyMotion motion;
    for (const Vector3<double>& hip : hips[n]) {
      const Eigen::Vector3d move = hip - first.col(kBodyHip);
      motion.push_back(first.colwise() + move);
    }
    carried.push_back(std::move(motion));
  }
  return carried;
}

}  // namespace

std::optional<GroupMetrics> CompareHips(const std::vector<PendulumRecording>& recordings,
                                        const RecordedBodies& bodies,
                                        const std::vector<PredictedGroup>& predicted) {
  if (predicted.empty()) return std::nullopt;
  GroupMetrics metrics;
  std::vector<GroupMotion> recorded, motions;
  std::set<int> seen;
  for (const PredictedGroup& group : predicted) {
    const PendulumRecording& recording = recordings[group.recording];
    const double dt = recording.scene.dt;
    AddOnsets({OnsetFrames(recording.hip), recording.pushed_person, dt}, OnsetFrames(group.hips),
              &metrics.onsets);
    if (bodies.empty()) continue;
    const std::vector<BodyMotion>& people = bodies[group.recording];
    // Each recording is there to compare with once, however often it was predicted.
    if (seen.insert(group.recording).second) recorded.push_back({people, dt});
    motions.push_back({Carried(people, group.hips), dt});
  }
  if (bodies.empty()) return metrics;
  metrics.social = CompareStates(recorded, motions);
  metrics.social.ndms = CompareWords(recorded, motions);
  return metrics;
}

}  // namespace pushid
