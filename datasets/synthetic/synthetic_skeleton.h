// datasets: a rigid human skeleton of 22 joints whose pendulum is known exactly.
//
// Legs, pelvis and the line between the ankles form a parallelogram: the hip joints are carried at
// +-w to the side of the root, the ankles at +-w to the side of the cart, trunk and feet stay
// level. Both legs are then parallel to the rod and as long, whatever the lean, so that
//   - the ankles' midpoint is the cart at constant height, the root is HipPosition,
//   - every bone keeps its length, and the knees their small constant bend.
// Rejected: feet fixed under a pelvis that tilts with the rod. The legs would have to change their
// length, or the ankles their height, and the mapped pendulum would not be the one rolled out.
//
// The root and both ankles have position channels, so that noise reaches hip and ankles
// independently; without noise the ankles' channels equal their offsets.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "datasets/formats/bvh.h"

namespace pushid {

// Joint indices in the skeleton of the published recordings of those the pendulum is read from.
inline constexpr int kHipJoint = 0, kRightAnkleJoint = 16, kLeftAnkleJoint = 20;
inline constexpr int kSkeletonJoints = 22;

// Positions that one frame is posed from, metres, and the rod's angles, radians.
struct SkeletonPose {
  double theta = 0.0, phi = 0.0;
  Eigen::Vector3d hip, left_ankle, right_ankle;
};

class SyntheticSkeleton {
 public:
  // Standing upright, the hip is rod_length (m) above the midpoint of the ankles.
  explicit SyntheticSkeleton(double rod_length);

  double rod_length() const { return rod_; }
  double cart_height() const;              // of the ankles above the ground, m
  Eigen::Vector3d HalfStance() const;      // from the cart to the left ankle, m
  BvhSkeleton Bvh(LengthUnit unit) const;  // offsets, names, channels

  // The channel values of one frame, in file order, lengths in `unit`, appended to `values`.
  void AppendFrame(const SkeletonPose& pose, LengthUnit unit, std::vector<double>* values) const;

 private:
  double rod_;   // m
  double bone_;  // thigh and shank, m
  double bend_;  // of thigh forward and shank backward against the rod, rad
};

}  // namespace pushid
