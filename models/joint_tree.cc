// models: forward kinematics.
#include "models/joint_tree.h"

#include <cmath>

namespace pushid {

Eigen::Matrix3d Rodrigues(const Eigen::Vector3d& map) {
  const double angle = map.norm();
  const Eigen::Vector3d axis = map / (angle + 1e-7);
  Eigen::Matrix3d cross;
  cross << 0, -axis.z(), axis.y(), axis.z(), 0, -axis.x(), -axis.y(), axis.x(), 0;
  return Eigen::Matrix3d::Identity() + std::sin(angle) * cross +
         (1.0 - std::cos(angle)) * cross * cross;
}

Eigen::Matrix3Xd JointPositions(const JointTree& tree, const Eigen::VectorXd& maps) {
  Eigen::Matrix3Xd positions = tree.offsets;
  std::vector<Eigen::Matrix3d> turns(tree.num_joints());
  for (int i = 0; i < tree.num_joints(); ++i) {
    turns[i] = Rodrigues(maps.segment<3>(3 * i));
    const int parent = tree.parents[i];
    if (parent <= 0) continue;
    turns[i] *= turns[parent];
    positions.col(i) = turns[parent].transpose() * tree.offsets.col(i) + positions.col(parent);
  }
  return positions;
}

}  // namespace pushid
