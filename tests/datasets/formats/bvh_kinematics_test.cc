// Forward kinematics against cases worked out by hand and against a plain product of rotations.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

#include "datasets/formats/bvh.h"

namespace pushid {
namespace {

using Eigen::Vector3d;
using Channel = BvhChannel;

BvhJoint Joint(const std::string& name, int parent, const Vector3d& offset,
               std::vector<Channel> channels) {
  BvhJoint joint;
  joint.name = name;
  joint.parent = parent;
  joint.offset = offset;
  joint.channels = std::move(channels);
  return joint;
}

std::vector<Vector3d> Positions(const BvhSkeleton& skeleton, const std::vector<double>& row,
                                double metres_per_unit = 1.0) {
  std::vector<int> all;
  for (std::size_t i = 0; i < skeleton.joints.size(); ++i) all.push_back(static_cast<int>(i));
  std::vector<Vector3d> positions(all.size(), Vector3d::Constant(std::nan("")));
  BvhKinematics(skeleton, metres_per_unit, all).Positions(row.data(), positions.data());
  return positions;
}

void ExpectNear(const Vector3d& actual, const Vector3d& expected) {
  EXPECT_LT((actual - expected).norm(), 1e-12)
      << actual.transpose() << " instead of " << expected.transpose();
}

TEST(BvhKinematics, QuarterTurnsInTheOrderListed) {
  // A child one metre along x. R = Rz(90) Rx(90): x -> y. R = Rx(90) Rz(90): x -> y -> z.
  BvhSkeleton skeleton;
  skeleton.joints = {
      Joint("root", -1, Vector3d::Zero(), {Channel::kZrotation, Channel::kXrotation}),
      Joint("child", 0, Vector3d(1, 0, 0), {})};
  ExpectNear(Positions(skeleton, {90, 90})[1], Vector3d(0, 1, 0));
  skeleton.joints[0].channels = {Channel::kXrotation, Channel::kZrotation};
  ExpectNear(Positions(skeleton, {90, 90})[1], Vector3d(0, 0, 1));
  // Signs: a positive turn about y takes z to x and x to -z.
  skeleton.joints[0].channels = {Channel::kYrotation};
  ExpectNear(Positions(skeleton, {90})[1], Vector3d(0, 0, -1));
}

TEST(BvhKinematics, PositionsBehindRotationsAndOnOtherJoints) {
  BvhSkeleton skeleton;
  skeleton.joints = {
      Joint("root", -1, Vector3d(9, 9, 9),
            {Channel::kZrotation, Channel::kZposition, Channel::kXposition, Channel::kYposition}),
      // Only y moves: x and z keep the offset.
      Joint("slider", 0, Vector3d(1, 2, 3), {Channel::kYposition, Channel::kXrotation}),
      Joint("tip", 1, Vector3d(0, 1, 0), {})};
  const std::vector<Vector3d> p = Positions(skeleton, {90, 30, 10, 20, 5, 90});
  ExpectNear(p[0], Vector3d(10, 20, 30));  // replaces the offset
  // Local (1, 5, 3), turned by 90 degrees about z: (-5, 1, 3).
  ExpectNear(p[1], Vector3d(5, 21, 33));
  // (0, 1, 0) turned about x to (0, 0, 1), which z leaves alone.
  ExpectNear(p[2], Vector3d(5, 21, 34));
}

TEST(BvhKinematics, MillimetresBecomeMetres) {
  BvhSkeleton skeleton;
  skeleton.joints = {Joint("root", -1, Vector3d::Zero(), DefaultBvhChannels(true)),
                     Joint("child", 0, Vector3d(0, 0, -450), {})};
  const auto p = Positions(skeleton, {1000, 2000, 950, 0, 0, 0}, 1e-3);
  ExpectNear(p[0], Vector3d(1, 2, 0.95));
  ExpectNear(p[1], Vector3d(1, 2, 0.5));
}

// Every order of the three rotations, random chains, against Eigen's angle-axis products; chosen
// joints give what all joints give.
TEST(BvhKinematics, AgreesWithRotationProducts) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> angle(-400.0, 400.0), length(-1.0, 1.0);
  std::vector<Channel> order = {Channel::kXrotation, Channel::kYrotation, Channel::kZrotation};
  do {
    BvhSkeleton skeleton;
    std::vector<double> row;
    std::vector<Eigen::Matrix3d> rotation;
    std::vector<Vector3d> expected;
    for (int i = 0; i < 7; ++i) {
      const int parent = i == 0 ? -1 : (i == 4 ? 1 : i - 1);
      const Vector3d offset(length(random), length(random), length(random));
      skeleton.joints.push_back(Joint("j" + std::to_string(i), parent, offset, order));
      Eigen::Matrix3d local = Eigen::Matrix3d::Identity();
      for (Channel channel : order) {
        row.push_back(angle(random));
        local =
            local * Eigen::AngleAxisd(row.back() * M_PI / 180.0, Vector3d::Unit(AxisOf(channel)));
      }
      rotation.push_back(parent < 0 ? local : Eigen::Matrix3d(rotation[parent] * local));
      expected.push_back(parent < 0 ? offset : expected[parent] + rotation[parent] * offset);
    }
    const std::vector<Vector3d> p = Positions(skeleton, row);
    for (int i = 0; i < 7; ++i) ExpectNear(p[i], expected[i]);

    std::vector<Vector3d> chosen(2);
    BvhKinematics(skeleton, 1.0, {5, 2}).Positions(row.data(), chosen.data());
    EXPECT_EQ(chosen[0], p[5]);
    EXPECT_EQ(chosen[1], p[2]);
  } while (std::next_permutation(order.begin(), order.end()));
}

}  // namespace
}  // namespace pushid
