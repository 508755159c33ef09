// ident: the joints that a person came with, and how they go with the 22 roles of a body.
//
// Bodies are predicted by role (datasets/manifest/body_roles.h); a motion is then taken back to the
// skeleton it came from. Its joints turn so that those with a role come as near as bones of
// constant length can to where the body wants them (FitTree); a joint
// without a role follows its parent.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "datasets/manifest/recording.h"
#include "models/restoration/body.h"

namespace pushid {

struct BodySkeleton {
  std::vector<std::string> names;
  std::vector<int> parents;  // -1: a root; every parent precedes its children
  std::vector<int> roles;    // the role that a joint plays; -1: none
  // At frame 0, m, world: the joints, then the filled roles beyond the last joint of a limb (toes,
  // head), which the joint before them turns towards.
  Eigen::Matrix3Xd rest;
  JointAims tree;
  std::vector<int> wanted_roles;                  // by column of rest; -1: nothing is wanted of it
  Eigen::Vector3d hip = Eigen::Vector3d::Zero();  // the body's, in the rest
  std::optional<FileSkeleton> file;               // of a BVH file, whose hierarchy is kept

  int num_joints() const { return static_cast<int>(names.size()); }
};

// "Hips", "Spine", ...: where a recording gives no names.
std::vector<std::string> DefaultJointNames();

// The 22 roles themselves, as they stand in a pose.
BodySkeleton RoleSkeleton(const Pose& first, const std::vector<std::string>& names);

// That of a person read with all joints: the hierarchy of a BVH file; of points, the 22 roles.
BodySkeleton SkeletonOf(const RecordedPerson& person);

struct PosedJoints {
  // m, world, a column a joint: those with a role where the body has it, the others by their
  // parent's rotation.
  Eigen::Matrix3Xd positions;
  std::vector<Eigen::Matrix3d> rotations;  // world, against the rest
};
PosedJoints Retarget(const BodySkeleton& skeleton, const Pose& pose);

}  // namespace pushid
