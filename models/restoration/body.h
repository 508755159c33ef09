// models: the body of restorations: 22 joints in the order of the published recordings.
//
//   0 hip; 1-3 spine; 4 neck; 5 head; 6-9 right clavicle, shoulder, elbow, wrist; 10-13 left;
//   14-17 right hip, knee, ankle, toe; 18-21 left. Every parent precedes its children.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "models/ipm.h"

namespace pushid {

inline constexpr int kBodyJoints = 22;
inline constexpr std::array<int, kBodyJoints> kBodyParents = {
    -1, 0, 1, 2, 3, 4, 3, 6, 7, 8, 3, 10, 11, 12, 0, 14, 15, 16, 0, 18, 19, 20};

enum BodyJoint {
  kBodyHip = 0,
  kLowerSpine = 1,
  kMiddleSpine = 2,
  kUpperSpine = 3,
  kNeck = 4,
  kBodyHead = 5,
  kRightClavicle = 6,
  kRightShoulder = 7,
  kRightElbow = 8,
  kRightWrist = 9,
  kLeftClavicle = 10,
  kLeftShoulder = 11,
  kLeftWrist = 13,
  kRightHip = 14,
  kRightKnee = 15,
  kRightAnkle = 16,
  kRightToe = 17,
  kLeftHip = 18,
  kLeftKnee = 19,
  kLeftAnkle = 20,
  kLeftToe = 21
};

// A column per joint, m, world.
using Pose = Eigen::Matrix<double, 3, kBodyJoints>;
using BodyMotion = std::vector<Pose>;  // frame by frame

// The joint on the other side of the body.
int MirroredJoint(int joint);

// The pose seen in the mirror plane y = 0: y changes its sign, left and right change places.
Pose Mirrored(const Pose& pose);

// |joint - parent|, m; zero for the hip.
Eigen::Matrix<double, kBodyJoints, 1> BoneLengths(const Pose& pose);

// Thigh and shank, mean of both legs, m.
double LegLength(const Pose& pose);

// The angle about z of the direction that the body faces, perpendicular to the lines between the
// hip joints and between the shoulders; 0 is +x. Zero for a body without width.
double Heading(const Pose& pose);

inline Eigen::Matrix3d TurnAboutZ(double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  Eigen::Matrix3d turn;
  turn << c, -s, 0, s, c, 0, 0, 0, 1;
  return turn;
}

// A rotation as networks represent it: its first two columns (Zhou et al., On the continuity of
// rotation representations in neural networks, CVPR 2019), which are continuous, unlike angles or
// quaternions.
using Rotation6d = Eigen::Matrix<double, 6, 1>;
Rotation6d ToRotation6d(const Eigen::Matrix3d& rotation);

// The smallest rotation from direction `from` to direction `to`; the identity if one of them has no
// length. For opposite directions the axis is any perpendicular one.
Eigen::Matrix3d SwingBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

// argmin over R of sum |R from_i - to_i|^2 (Kabsch), a proper rotation.
Eigen::Matrix3d FitRotation(const std::vector<Eigen::Vector3d>& from,
                            const std::vector<Eigen::Vector3d>& to);

// A wanted pose transferred to a person's own skeleton, so that every bone keeps its length.
//
// The skeleton is the person's pose at frame 0, where all rotations are the identity and the
// offsets are the differences of the joints. From the hip outwards, each joint turns so that its
// children come as near as possible to their wanted places: one child by the smallest swing that
// points at it, several (hip, chest) by the best rigid fit. The positions are then those of forward
// kinematics, and a BVH file represents them exactly. Rejected: scaling each bone along its wanted
// direction, which keeps lengths too but distorts pelvis and shoulders, and is no hierarchy of
// rotations.
struct FittedTree {
  Eigen::Matrix3Xd positions;
  std::vector<Eigen::Matrix3d> rotations;  // world, against the rest pose
};
FittedTree FitSkeleton(const Pose& rest, const Pose& wanted);

// Any tree of joints. Parents precede their children; -1: a root, which moves to its wanted place.
// A joint turns towards its `aims` (joints further out), or with its parent if it has none.
struct JointAims {
  std::vector<int> parents;
  std::vector<std::vector<int>> aims;
};
FittedTree FitTree(const JointAims& tree, const Eigen::Matrix3Xd& rest,
                   const Eigen::Matrix3Xd& wanted);

// Turns both bones of a leg so that the ankle reaches `target`, or comes as near as the leg's
// length allows; the knee stays in its plane, and the toe keeps its place relative to the ankle.
// Returns the remaining distance between ankle and target, m.
double ReachWithLeg(bool left, const Eigen::Vector3d& target, Pose* pose);

}  // namespace pushid
