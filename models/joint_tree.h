// models: joint positions of a body that is given by exponential maps, one rotation vector a joint.
//
// With row vectors, as the data's literature has them: R_i = Rodrigues(r_i) with angle |r_i| and
// axis r_i / (|r_i| + 1e-7). A joint with parent p > 0 turns with it, R_i <- R_i R_p, and stands at
// x_i = offset_i R_p + x_p; a joint whose parent is the root, and the root, keep R_i and stand at
// their offset. So the pose has neither the place nor the heading of the body.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace pushid {

struct JointTree {
  std::vector<int> parents;  // -1: the root; every parent precedes its children
  Eigen::Matrix3Xd offsets;  // a column a joint, m

  int num_joints() const { return static_cast<int>(parents.size()); }
};

// Turns row vectors: x R.
Eigen::Matrix3d Rodrigues(const Eigen::Vector3d& map);

// A column a joint, m. maps: three numbers a joint.
Eigen::Matrix3Xd JointPositions(const JointTree& tree, const Eigen::VectorXd& maps);

}  // namespace pushid
