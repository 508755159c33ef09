// models: symmetry and measures of the body.
#include "models/restoration/body.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "models/decompositions.h"

namespace pushid {
namespace {

// A fully stretched knee has no direction to bend in.
constexpr double kMostStretched = 0.9995;
constexpr double kStraight = 1e-4;  // m

constexpr double kNoLength = 1e-9;

}  // namespace

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

FittedTree FitTree(const JointAims& tree, const Eigen::Matrix3Xd& rest,
                   const Eigen::Matrix3Xd& wanted) {
  const int joints = static_cast<int>(tree.parents.size());
  FittedTree posed{Eigen::Matrix3Xd(3, joints), std::vector<Eigen::Matrix3d>(joints)};
  std::vector<Eigen::Vector3d> from, to;
  for (int j = 0; j < joints; ++j) {
    const int above = tree.parents[j];
    const Eigen::Matrix3d parent = above < 0 ? Eigen::Matrix3d::Identity() : posed.rotations[above];
    posed.positions.col(j) = wanted.col(j);
    if (above >= 0) {
      posed.positions.col(j) =
          posed.positions.col(above) + parent * (rest.col(j) - rest.col(above));
    }
    const std::vector<int>& aims = tree.aims[j];
    Eigen::Matrix3d& rotation = posed.rotations[j];
    rotation = parent;
    if (aims.size() == 1) {
      const Eigen::Vector3d offset = rest.col(aims[0]) - rest.col(j);
      const Eigen::Vector3d aim = wanted.col(aims[0]) - posed.positions.col(j);
      rotation = SwingBetween(parent * offset, aim) * parent;
    } else if (aims.size() > 1) {
      from.clear(), to.clear();
      for (int aim : aims) {
        from.push_back(rest.col(aim) - rest.col(j));
        to.push_back(wanted.col(aim) - posed.positions.col(j));
      }
      rotation = FitRotation(from, to);
    }
  }
  return posed;
}

FittedTree FitSkeleton(const Pose& rest, const Pose& wanted) {
  static const JointAims body = [] {
    JointAims tree;
    tree.parents.assign(kBodyParents.begin(), kBodyParents.end());
    tree.aims.resize(kBodyJoints);
    for (int j = 1; j < kBodyJoints; ++j) tree.aims[kBodyParents[j]].push_back(j);
    return tree;
  }();
  return FitTree(body, rest, wanted);
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
  // The law of cosines gives the knee's place along the line from hip to target, and beside it.
  const double foot = (thigh * thigh + distance * distance - shank * shank) / (2.0 * distance);
  const double beside = std::sqrt(std::max(0.0, thigh * thigh - foot * foot));
  // The knee keeps its side, turned with the leg; a straight leg bends towards the toe.
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

Rotation6d ToRotation6d(const Eigen::Matrix3d& rotation) {
  Rotation6d numbers;
  numbers << rotation.col(0), rotation.col(1);
  return numbers;
}

Eigen::Matrix3d SwingBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  if (!(from.norm() > kNoLength) || !(to.norm() > kNoLength)) return Eigen::Matrix3d::Identity();
  return TurnBetween(from, to).toRotationMatrix();
}

Eigen::Matrix3d FitRotation(const std::vector<Eigen::Vector3d>& from,
                            const std::vector<Eigen::Vector3d>& to) {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (size_t i = 0; i < from.size(); ++i) covariance += to[i] * from[i].transpose();
  return NearestRotation(covariance);
}

}  // namespace pushid
