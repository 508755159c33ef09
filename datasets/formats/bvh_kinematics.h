// datasets: forward kinematics of a BVH skeleton: world positions from one row of channel values.
// The conventions are those of bvh.h.
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "datasets/formats/bvh.h"

namespace pushid {

// rotation <- rotation * R1 R2 R3 of the joint's rotation channels, `values` being those of all its
// channels.
void RotateByChannels(const BvhJoint& joint, const double* values, Eigen::Matrix3d* rotation);

// The angles of the joint's rotation channels that turn it by `rotation`, degrees; `values` are
// those of all its channels, of which the positions stay. The joint has all three axes.
void SetRotationChannels(const BvhJoint& joint, const Eigen::Matrix3d& rotation, double* values);

// Computes only what the chosen joints need: their ancestors, and the rotations of those.
class BvhKinematics {
 public:
  // `joints` are valid indices into the skeleton, in the order of the output.
  BvhKinematics(const BvhSkeleton& skeleton, double metres_per_unit, std::vector<int> joints);
  BvhKinematics(const BvhSkeleton& skeleton, LengthUnit unit, std::vector<int> joints)
      : BvhKinematics(skeleton, MetresPer(unit), std::move(joints)) {}

  // `row` holds num_channels() values (file lengths, degrees); writes one position per chosen
  // joint, metres. Not const: the work space belongs to the object.
  void Positions(const double* row, Eigen::Vector3d* positions);

 private:
  struct Step {
    int joint = 0;
    int parent = -1;
    bool rotates_something = false;  // a joint further down needs its rotation
    int first_channel = 0;           // index of the joint's first value in a row
  };

  const BvhSkeleton skeleton_;
  const double metres_per_unit_;
  const std::vector<int> joints_;
  std::vector<Step> steps_;  // needed joints, parents first
  std::vector<Eigen::Vector3d> world_position_;
  std::vector<Eigen::Matrix3d> world_rotation_;
};

}  // namespace pushid
