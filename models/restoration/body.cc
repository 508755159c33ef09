// models: symmetry and measures of the body.
#include "models/restoration/body.h"

namespace pushid {

int MirroredJoint(int joint) {
  if (joint < 6) return joint;
  if (joint < 14) return joint < 10 ? joint + 4 : joint - 4;
  return joint < 18 ? joint + 4 : joint - 4;
}

Pose Mirrored(const Pose& pose) {
  Pose mirrored;
  for (int j = 0; j < kBodyJoints; ++j) {
    mirrored.col(MirroredJoint(j)) << pose(0, j), -pose(1, j), pose(2, j);
  }
  return mirrored;
}

Eigen::Matrix<double, kBodyJoints, 1> BoneLengths(const Pose& pose) {
  Eigen::Matrix<double, kBodyJoints, 1> lengths;
  lengths[0] = 0.0;
  for (int j = 1; j < kBodyJoints; ++j) {
    lengths[j] = (pose.col(j) - pose.col(kBodyParents[j])).norm();
  }
  return lengths;
}

double LegLength(const Pose& pose) {
  const auto bone = BoneLengths(pose);
  return 0.5 * (bone[kRightKnee] + bone[kRightAnkle] + bone[kLeftKnee] + bone[kLeftAnkle]);
}

double Heading(const Pose& pose) {
  const Eigen::Vector3d left =
      pose.col(kLeftHip) - pose.col(kRightHip) + pose.col(kLeftShoulder) - pose.col(kRightShoulder);
  return std::atan2(-left.x(), left.y());
}

}  // namespace pushid
