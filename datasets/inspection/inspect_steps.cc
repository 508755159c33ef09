// datasets: points of a motion file with their gaps, and the steps of the feet among them.
#include "datasets/inspection/inspect_steps.h"

#include <algorithm>

#include "datasets/loading/motion_preparation.h"

namespace pushid {

namespace {
using Track = std::vector<Eigen::Vector3d>;
}  // namespace

Track MeanOf(const PointMotion& motion, const std::vector<int>& chosen) {
  Track mean(motion.num_frames(), Eigen::Vector3d::Zero());
  for (int index : chosen) {
    for (int t = 0; t < motion.num_frames(); ++t) mean[t] += motion.positions[index][t];
  }
  for (Eigen::Vector3d& position : mean) position /= static_cast<double>(chosen.size());
  return mean;
}

int LongestHidden(const PointMotion& motion, const std::vector<int>& chosen) {
  int longest = 0;
  for (int index : chosen) {
    int run = 0;
    for (const Eigen::Vector3d& position : motion.positions[index]) {
      run = position.allFinite() ? 0 : run + 1;
      longest = std::max(longest, run);
    }
  }
  return longest;
}

PersonSteps StepsOf(const PointMotion& motion, const PendulumJoints& joints,
                    const Eigen::Matrix3d& to_project) {
  const auto track = [&](const std::vector<int>& chosen) {
    Track mean = MeanOf(motion, chosen);
    for (Eigen::Vector3d& position : mean) position = to_project * position;
    return mean;
  };
  // As loading does: a toe or heel that is lost for long is not used.
  const double gap = PreparationOptions{}.max_gap_s * motion.rate_hz;
  const auto if_seen = [&](const std::vector<int>& chosen) {
    return chosen.empty() || LongestHidden(motion, chosen) > gap ? Track() : track(chosen);
  };
  RecordedPerson person;
  person.left_ankle = track(joints.left_ankle);
  person.right_ankle = track(joints.right_ankle);
  person.left_toe = if_seen(joints.left_toe);
  person.right_toe = if_seen(joints.right_toe);
  person.left_heel = if_seen(joints.left_heel);
  person.right_heel = if_seen(joints.right_heel);
  return FindSteps(person, motion.rate_hz);
}

}  // namespace pushid
