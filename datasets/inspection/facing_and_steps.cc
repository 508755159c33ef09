// datasets: where a person of a file faces and steps.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "datasets/inspection/push_and_motion.h"
#include "datasets/loading/motion_preparation.h"

namespace pushid {
namespace {

using Track = std::vector<Eigen::Vector3d>;

constexpr double kTurned = 0.5;    // rad between the ankles' line at first and in the mean
constexpr double kSideways = 0.8;  // rad between the way of a walk and where the person faces
constexpr double kStride = 1.0;    // s, about
constexpr double kWalked = 0.3;    // m; less has no direction

// The axis nearest to the rod.
Eigen::Vector3d UpOf(const Eigen::Vector3d& rod) {
  Eigen::Vector3d up = Eigen::Vector3d::Zero();
  const int axis = LargestAxis(rod);
  up[axis] = rod[axis] < 0.0 ? -1.0 : 1.0;
  return up;
}

// Across `up`; zero where it is not seen.
Eigen::Vector3d Across(const Eigen::Vector3d& v, const Eigen::Vector3d& up) {
  return v.allFinite() ? Eigen::Vector3d(v - v.dot(up) * up) : Eigen::Vector3d::Zero();
}

double Angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::clamp(a.normalized().dot(b.normalized()), -1.0, 1.0));
}

std::string Degrees(double radians) {
  return std::to_string(std::lround(radians * 180.0 / M_PI)) + " degrees";
}

// The farthest that the hip gets, at either end of the recording.
Eigen::Vector3d WayOf(const Track& hip, const Eigen::Vector3d& up, int first) {
  for (size_t t = hip.size(); t-- > static_cast<size_t>(first);) {
    if (hip[t].allFinite()) return Across(hip[t] - hip[first], up);
  }
  return Eigen::Vector3d::Zero();
}

}  // namespace

PelvisSides SidesOf(const Result<BodyRoles>& roles) {
  if (!roles.ok()) return {};
  const BodyRoles& r = roles.value();
  if (!r.left_asis.empty() && !r.right_asis.empty()) return {r.left_asis, r.right_asis};
  return {r.joints[kLeftHip], r.joints[kRightHip]};
}

Facing FacingOf(const PointMotion& motion, const PelvisSides& pelvis, const Track& hip,
                const Track& left, const Track& right, const Eigen::Vector3d& rod, int first,
                double metres) {
  const Eigen::Vector3d up = UpOf(rod);
  Facing facing;
  if (pelvis.known()) {
    const Eigen::Vector3d line =
        MeanOf(motion, pelvis.left)[first] - MeanOf(motion, pelvis.right)[first];
    facing.to_the_left = Across(line, up);
    facing.by = "the pelvis";
    if (!facing.to_the_left.isZero()) return facing;
  }
  const size_t stride = motion.rate_hz > 0.0 ? static_cast<size_t>(kStride * motion.rate_hz) : 1;
  for (size_t t = first; t < std::min(left.size(), first + stride); ++t) {
    facing.to_the_left += Across(left[t] - right[t], up);
  }
  facing.by = "the ankles";
  const Eigen::Vector3d at_first = Across(left[first] - right[first], up);
  const Eigen::Vector3d way = WayOf(hip, up, first);
  const Eigen::Vector3d forward = facing.to_the_left.cross(up);
  if (facing.to_the_left.isZero() || at_first.isZero()) {
    facing.doubt = "the ankles are in one place";
  } else if (Angle(at_first, facing.to_the_left) > kTurned) {
    facing.doubt = "one foot is ahead, or the person turns: the line between the ankles turns by " +
                   Degrees(Angle(at_first, facing.to_the_left));
  } else if (metres * way.norm() > kWalked && Angle(way, forward) > kSideways) {
    facing.doubt = "the hip goes " + Degrees(Angle(way, forward)) + " off it";
  }
  return facing;
}

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
  RecordedPerson person;
  for (const PendulumTrack& row : kPendulumTracks) {
    const std::vector<int>& chosen = joints.*row.joints;
    const bool lost = chosen.empty() || LongestHidden(motion, chosen) > gap;
    if (row.required || !lost) person.*row.track = track(chosen);
  }
  return FindSteps(person, motion.rate_hz);
}

}  // namespace pushid
