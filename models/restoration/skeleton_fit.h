// models: a wanted pose carried out by a person's own skeleton, so that every bone keeps its
// length.
//
// The skeleton is the person's pose at frame 0: there all rotations are the identity and the
// offsets are the differences of the joints. From the hip outwards each joint turns so that its
// children come as near as they can to where they are wanted: one child by the smallest swing that
// points at it, several (hip, chest) by the best rigid fit. Positions then are those of forward
// kinematics, and a BVH file holds them exactly. Rejected: scaling each bone along its wanted
// direction. It keeps lengths too, but tears pelvis and shoulders out of shape, and no hierarchy of
// rotations can hold the result.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "models/restoration/body.h"

namespace pushid {

// The same for any tree of joints, a column each. Every parent precedes its children, -1 is a root,
// which goes where it is wanted; a joint turns towards its `aims`, joints further out, and without
// any it goes with its parent.
struct JointAims {
  std::vector<int> parents;
  std::vector<std::vector<int>> aims;
};
struct FittedTree {
  Eigen::Matrix3Xd positions;
  std::vector<Eigen::Matrix3d> rotations;  // world, against the rest
};
FittedTree FitTree(const JointAims& tree, const Eigen::Matrix3Xd& rest,
                   const Eigen::Matrix3Xd& wanted);

struct PosedSkeleton {
  Pose positions;
  std::array<Eigen::Matrix3d, kBodyJoints> rotations;  // world, against the rest pose
};

PosedSkeleton FitSkeleton(const Pose& rest, const Pose& wanted);

// Both bones of a leg turned so that the ankle reaches `target`, or comes as near as the leg is
// long; the knee stays in its plane, the toe keeps its place relative to the ankle. Returns how far
// the ankle stays from the target, m.
double ReachWithLeg(bool left, const Eigen::Vector3d& target, Pose* pose);

// Rotations, and the six numbers that networks describe them by.
//
// The first two columns, one after the other (Zhou et al., On the continuity of rotation
// representations in neural networks, CVPR 2019): unlike angles or quaternions without jumps.
using Rotation6d = Eigen::Matrix<double, 6, 1>;
Rotation6d ToRotation6d(const Eigen::Matrix3d& rotation);

// Gram and Schmidt; any six numbers whose columns are not parallel are a rotation. Parallel or
// vanishing columns give the identity.
Eigen::Matrix3d FromRotation6d(const Rotation6d& numbers);

// The smallest rotation that turns direction `from` into direction `to`; the identity where one of
// them has no length. Opposite directions turn about any axis square to them.
Eigen::Matrix3d SwingBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

// argmin over R of sum |R from_i - to_i|^2 (Kabsch), a proper rotation.
Eigen::Matrix3d FitRotation(const std::vector<Eigen::Vector3d>& from,
                            const std::vector<Eigen::Vector3d>& to);

}  // namespace pushid
