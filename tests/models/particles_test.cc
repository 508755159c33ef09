// Kinematics by hand; particles in the mirror and on their bones.
#include "models/particles.h"

#include <gtest/gtest.h>

namespace pushid {
namespace {

// A quarter turn about z: row vectors turn x into y's negative... by hand, x R with
// R = [0 -1 0; 1 0 0; 0 0 1] gives (1, 0, 0) -> (0, -1, 0).
TEST(JointTreeTest, TurnsChildrenByTheRotationsAboveThem) {
  JointTree tree;
  tree.parents = {-1, 0, 1, 2};
  tree.offsets = Eigen::Matrix3Xd::Zero(3, 4);
  tree.offsets.row(0) << 0, 1, 1, 1;
  Eigen::VectorXd maps = Eigen::VectorXd::Zero(12);
  maps(2) = 1.0;       // the root's own rotation moves nothing
  maps(5) = M_PI / 2;  // joint 1, a child of the root: turns what hangs on it
  const Eigen::Matrix3Xd x = JointPositions(tree, maps);
  EXPECT_LT((x.col(1) - Eigen::Vector3d(1, 0, 0)).norm(), 1e-9);
  EXPECT_LT((x.col(2) - Eigen::Vector3d(1, -1, 0)).norm(), 1e-6);
  EXPECT_LT((x.col(3) - Eigen::Vector3d(1, -2, 0)).norm(), 1e-6);
  maps(8) = M_PI / 2;  // and joint 2 besides: half a turn for joint 3
  EXPECT_LT((JointPositions(tree, maps).col(3) - Eigen::Vector3d(0, -1, 0)).norm(), 1e-6);
}

TEST(JointTreeTest, RotationsAreRotations) {
  for (const double size : {0.0, 1e-8, 0.5, 3.0}) {
    const Eigen::Matrix3d turn = Rodrigues(size * Eigen::Vector3d(0.6, 0.0, -0.8));
    EXPECT_LT((turn * turn.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-6) << size;
    EXPECT_NEAR(turn.trace(), 1.0 + 2.0 * std::cos(size), 1e-6) << size;
  }
}

// A trunk on a fixed point, an arm to each side; the first has the weight of two joints.
ParticleLayout TwoArms() {
  ParticleLayout layout;
  layout.names = {"trunk", "left", "right"};
  layout.mirrored = {0, 2, 1};
  layout.parents = {kFixedPoint, 0, 0};
  layout.fixed = Eigen::Matrix3Xf::Zero(3, 3);
  layout.weights = {2.0f, 1.0f, 1.0f};
  layout.joints = 8;
  return layout;
}

Trajectories Pose(std::initializer_list<float> values) {
  Trajectories pose(static_cast<Eigen::Index>(values.size()), 1);
  std::copy(values.begin(), values.end(), pose.data());
  return pose;
}

TEST(ParticlesTest, AMirrorChangesSidesAndOneSign) {
  const Trajectories pose = Pose({0.1f, 1, 0, 0.5f, 1, 0.2f, -0.4f, 1.1f, 0});
  const Trajectories expected = Pose({-0.1f, 1, 0, 0.4f, 1.1f, 0, -0.5f, 1, 0.2f});
  EXPECT_EQ(Mirrored(pose, TwoArms()), expected);
  EXPECT_EQ(Mirrored(expected, TwoArms()), pose);
}

TEST(ParticlesTest, BonesGetTheirLengthsBackParentsFirst) {
  const Trajectories like = Pose({0, 1, 0, 1, 1, 0, -1, 1, 0});
  Trajectories pose = Pose({0, 2, 0, 0, 4, 0, -3, 1, 0});
  ProjectBones(like, TwoArms(), &pose);
  EXPECT_LT((pose - Pose({0, 1, 0, 0, 2, 0, -1, 1, 0})).norm(), 1e-6f);
  EXPECT_LT((BoneLengths(pose, TwoArms()) - BoneLengths(like, TwoArms())).norm(), 1e-6f);
}

TEST(ParticlesTest, ParticlesWithoutBonesStayWhereTheyAre) {
  ParticleLayout layout = TwoArms();
  layout.parents[0] = kNoBone;
  Trajectories pose = Pose({0, 2, 0, 0, 4, 0, -3, 2, 0});
  ProjectBones(Pose({0, 1, 0, 1, 1, 0, -1, 1, 0}), layout, &pose);
  EXPECT_LT((pose - Pose({0, 2, 0, 0, 3, 0, -1, 2, 0})).norm(), 1e-6f);
}

// The trunk errs by 1 and stands for two joints, the left arm by 2; of eight joints.
TEST(ParticlesTest, MeansCountTheJointsThatAParticleStandsFor) {
  const Trajectories a = Pose({0, 0, 0, 0, 0, 0, 0, 0, 0}), b = Pose({1, 0, 0, 0, 0, 2, 0, 0, 0});
  EXPECT_FLOAT_EQ(MeanDistance(a, b, TwoArms())(0), (2 * 1 + 2) / 8.0f);
}

}  // namespace
}  // namespace pushid
