// models: forward kinematics towards wanted positions; two-bone inverse kinematics.
#include "models/restoration/skeleton_fit.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "models/restoration/rotations.h"

namespace pushid {
namespace {

using Children = std::array<std::vector<int>, kBodyJoints>;

const Children& BodyChildren() {
  static const Children children = [] {
    Children lists;
    for (int j = 1; j < kBodyJoints; ++j) lists[kBodyParents[j]].push_back(j);
    return lists;
  }();
  return children;
}

// A stretched knee has no direction to bend in, hence never quite stretched.
constexpr double kMostStretched = 0.9995;
constexpr double kStraight = 1e-4;  // m

}  // namespace

PosedSkeleton FitSkeleton(const Pose& rest, const Pose& wanted) {
  PosedSkeleton posed;
  posed.positions.col(0) = wanted.col(0);
  std::vector<Eigen::Vector3d> from, to;
  for (int j = 0; j < kBodyJoints; ++j) {
    const std::vector<int>& children = BodyChildren()[j];
    const Eigen::Matrix3d parent =
        j == 0 ? Eigen::Matrix3d::Identity() : posed.rotations[kBodyParents[j]];
    Eigen::Matrix3d& rotation = posed.rotations[j];
    rotation = parent;
    if (children.size() == 1) {
      const Eigen::Vector3d offset = rest.col(children[0]) - rest.col(j);
      const Eigen::Vector3d aim = wanted.col(children[0]) - posed.positions.col(j);
      rotation = SwingBetween(parent * offset, aim) * parent;
    } else if (children.size() > 1) {
      from.clear(), to.clear();
      for (int child : children) {
        from.push_back(rest.col(child) - rest.col(j));
        to.push_back(wanted.col(child) - posed.positions.col(j));
      }
      rotation = FitRotation(from, to);
    }
    for (int child : children) {
      posed.positions.col(child) =
          posed.positions.col(j) + rotation * (rest.col(child) - rest.col(j));
    }
  }
  return posed;
}

double ReachWithLeg(bool left, const Eigen::Vector3d& target, Pose* pose) {
  const int hip = left ? kLeftHip : kRightHip, knee = hip + 1, ankle = hip + 2, toe = hip + 3;
  const Eigen::Vector3d h = pose->col(hip), k = pose->col(knee), a = pose->col(ankle);
  const double thigh = (k - h).norm(), shank = (a - k).norm();
  Eigen::Vector3d along = target - h;
  double distance = along.norm();
  if (!(distance > 1e-6) || !(thigh > 0.0) || !(shank > 0.0)) return (target - a).norm();
  along /= distance;
  distance = std::clamp(distance, std::abs(thigh - shank) * 1.001 + 1e-6,
                        kMostStretched * (thigh + shank));
  // Law of cosines: how far along the line, and how far beside it, the knee stands.
  const double foot = (thigh * thigh + distance * distance - shank * shank) / (2.0 * distance);
  const double beside = std::sqrt(std::max(0.0, thigh * thigh - foot * foot));
  // The knee bends to the side it bent to, carried along with the leg; a straight leg bends towards
  // the toe.
  const Eigen::Vector3d was = (a - h).normalized();
  Eigen::Vector3d bend = (k - h) - was.dot(k - h) * was;
  if (!(bend.norm() > kStraight)) bend = pose->col(toe) - a;
  bend = SwingBetween(was, along) * bend;
  bend -= along.dot(bend) * along;
  const Eigen::Vector3d reached = h + distance * along;
  pose->col(toe) += reached - a;
  pose->col(knee) = h + foot * along + beside * bend.normalized();
  pose->col(ankle) = reached;
  return (target - reached).norm();
}

}  // namespace pushid
