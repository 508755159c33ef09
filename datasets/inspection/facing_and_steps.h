// datasets: where a person faces in the file's axes, and the steps of their feet.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/formats/point_motion.h"
#include "datasets/loading/foot_steps.h"
#include "datasets/manifest/body_roles.h"
#include "datasets/manifest/joint_choice.h"

namespace pushid {

// The axis that a direction is nearest to.
inline int LargestAxis(const Eigen::Vector3d& direction) {
  int axis = 0;
  direction.cwiseAbs().maxCoeff(&axis);
  return axis;
}

// "-y": the same with its sign.
inline std::string AxisName(const Eigen::Vector3d& direction) {
  const int axis = LargestAxis(direction);
  return std::string(direction[axis] < 0.0 ? "-" : "") + "xyz"[axis];
}

// Two points of the pelvis, one on each side, as indices; empty where there are none.
struct PelvisSides {
  std::vector<int> left{}, right{};
  bool known() const { return !left.empty() && !right.empty(); }
};
// The anterior iliac spines, or the hip joints, where the file has them itself.
PelvisSides SidesOf(const Result<BodyRoles>& roles);

struct Facing {
  Eigen::Vector3d to_the_left = Eigen::Vector3d::Zero();
  std::string by;     // "the pelvis", "the ankles"
  std::string doubt;  // empty: none
};

// By the pelvis at frame `first`; without one by the line between the ankles, meant over
// a second, as one foot is ahead in mid-stride. Doubtful where that line turns, or where the person
// walks to its side. rod: from ankles to hip; metres: of the file's unit.
Facing FacingOf(const PointMotion& motion, const PelvisSides& pelvis,
                const std::vector<Eigen::Vector3d>& hip, const std::vector<Eigen::Vector3d>& left,
                const std::vector<Eigen::Vector3d>& right, const Eigen::Vector3d& rod, int first,
                double metres);

// Points of a motion file with their gaps, and the steps of the feet among them.

// Frames in which all of the chosen points were seen have their mean, others NaN.
std::vector<Eigen::Vector3d> MeanOf(const PointMotion& motion, const std::vector<int>& chosen);

// Frames on end in which one of the chosen points was not seen.
int LongestHidden(const PointMotion& motion, const std::vector<int>& chosen);

// `to_project` takes the file's coordinates to metres, z up, x where the person faces.
PersonSteps StepsOf(const PointMotion& motion, const PendulumJoints& joints,
                    const Eigen::Matrix3d& to_project);

}  // namespace pushid
