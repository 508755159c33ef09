// models: the body that a restoration poses: 22 joints in the order of the published recordings.
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

// LDP's halves: what its lower and its upper network pose.
inline constexpr std::array<int, 9> kLowerJoints = {0, 14, 15, 16, 17, 18, 19, 20, 21};
inline constexpr std::array<int, 14> kUpperJoints = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13};

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

// Angle about z of where the body faces: square to the lines between the hip joints and between
// the shoulders; 0 is +x. Zero for a body without width.
double Heading(const Pose& pose);

// (x, y) turned about z by an angle.
inline Eigen::Matrix3d TurnAboutZ(double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  Eigen::Matrix3d turn;
  turn << c, -s, 0, s, c, 0, 0, 0, 1;
  return turn;
}

}  // namespace pushid
