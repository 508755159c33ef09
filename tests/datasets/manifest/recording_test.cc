// Roles that nobody plays are filled from their neighbours.
#include "datasets/manifest/recording.h"

#include <gtest/gtest.h>

#include "tests/models/body_samples.h"

namespace pushid {
namespace {

BodyRoles AllRoles() {
  BodyRoles roles;
  for (int role = 0; role < kBodyJoints; ++role) roles.joints[role] = {role};
  return roles;
}

std::vector<Eigen::Vector3d> JointsOf(const Pose& pose) {
  std::vector<Eigen::Vector3d> joints;
  for (int j = 0; j < kBodyJoints; ++j) joints.push_back(pose.col(j));
  return joints;
}

// The pose without some of its joints, filled again.
Pose Refilled(const Pose& pose, const std::vector<int>& lacking) {
  BodyRoles roles = AllRoles();
  for (int role : lacking) roles.joints[role].clear();
  EXPECT_EQ(FilledRoles(roles), lacking);
  EXPECT_TRUE(UnfilledRoles(roles).empty());
  return PoseOf(roles, JointsOf(pose));
}

TEST(BodyRolesTest, AllPlayedIsThePoseItselfAndSeveralPlayTheirMean) {
  const Pose pose = StandingPose();
  BodyRoles roles = AllRoles();
  EXPECT_EQ(PoseOf(roles, JointsOf(pose)), pose) << "to the last bit";
  roles.joints[kBodyHip] = {kLeftHip, kRightHip};
  EXPECT_LT((PoseOf(roles, JointsOf(pose)).col(0) - Eigen::Vector3d(0.02, 0, 0.92)).norm(), 1e-15);
}

// By hand: hip at 1.0 m, neck at 1.45 m; the spine's joints at quarters of the line between them.
TEST(BodyRolesTest, ASpineStandsEvenlyBetweenHipAndNeck) {
  const Pose filled = Refilled(StandingPose(), {kLowerSpine, kMiddleSpine, kUpperSpine});
  EXPECT_LT((filled.col(kLowerSpine) - Eigen::Vector3d(0.0175, 0, 1.1125)).norm(), 1e-12);
  EXPECT_LT((filled.col(kMiddleSpine) - Eigen::Vector3d(0.015, 0, 1.225)).norm(), 1e-12);
  EXPECT_LT((filled.col(kUpperSpine) - Eigen::Vector3d(0.0125, 0, 1.3375)).norm(), 1e-12);
  const Pose middle = Refilled(StandingPose(), {kMiddleSpine});
  EXPECT_LT((middle.col(2) - 0.5 * (middle.col(1) + middle.col(3))).norm(), 1e-12);
}

TEST(BodyRolesTest, NeckAndHead) {
  const Pose pose = StandingPose();
  const Pose necks = Refilled(pose, {kNeck});
  EXPECT_LT((necks.col(kNeck) - 0.5 * (pose.col(kUpperSpine) + pose.col(kBodyHead))).norm(), 1e-12);
  const Pose heads = Refilled(pose, {kBodyHead});
  EXPECT_LT((heads.col(kBodyHead) - Eigen::Vector3d(0.0166, 0, 1.549)).norm(), 1e-12);
  const Pose both = Refilled(pose, {kNeck, kBodyHead});
  EXPECT_LT((both.col(kNeck) - Eigen::Vector3d(-0.01, 0, 1.36)).norm(), 1e-12)
      << "between the shoulders";
}

// The fills turn with the body: nothing depends on where it faces.
TEST(BodyRolesTest, ToesPointForwardAndFillsTurnWithTheBody) {
  const std::vector<int> lacking = {kUpperSpine, kRightClavicle, kLeftClavicle, kRightToe,
                                    kLeftToe};
  const Pose filled = Refilled(StandingPose(), lacking);
  const double shank = (StandingPose().col(kLeftKnee) - StandingPose().col(kLeftAnkle)).norm();
  EXPECT_NEAR(filled(0, kLeftToe) - filled(0, kLeftAnkle), 0.42 * shank, 1e-12);
  EXPECT_NEAR(filled(2, kLeftToe) - filled(2, kLeftAnkle), -0.18 * shank, 1e-12);
  EXPECT_NEAR(filled(1, kLeftToe), filled(1, kLeftAnkle), 1e-12);
  EXPECT_LT(
      (filled.col(kLeftClavicle) - 0.5 * (filled.col(kUpperSpine) + filled.col(kLeftShoulder)))
          .norm(),
      1e-12);
  const Eigen::Vector3d move(1, -2, 0.3);
  const Pose turned = Refilled(Placed(StandingPose(), 0.7, move), lacking);
  EXPECT_LT((turned - Placed(filled, 0.7, move)).norm(), 1e-12);
}

// Bell et al. by hand: spines 0.24 m apart and 0.1 m before the back, all level.
TEST(BodyRolesTest, HipJointsFromPelvisMarkers) {
  BodyRoles roles = AllRoles();
  roles.joints[kLeftHip].clear();
  roles.joints[kRightHip].clear();
  EXPECT_EQ(RoleList(UnfilledRoles(roles)), "right_hip, left_hip");
  std::vector<Eigen::Vector3d> joints = JointsOf(StandingPose());
  joints.insert(joints.end(), {{0.1, 0.12, 1.05}, {0.1, -0.12, 1.05}, {-0.1, 0, 1.05}});
  roles.left_asis = {22};
  roles.right_asis = {23};
  roles.back = {24};
  EXPECT_TRUE(UnfilledRoles(roles).empty());
  const Pose pose = PoseOf(roles, joints);
  const Eigen::Vector3d left(0.1 - 0.19 * 0.24, 0.36 * 0.24, 1.05 - 0.3 * 0.24);
  EXPECT_LT((pose.col(kLeftHip) - left).norm(), 1e-12);
  EXPECT_LT((pose.col(kRightHip) - Eigen::Vector3d(left.x(), -left.y(), left.z())).norm(), 1e-12);
}

TEST(BodyRolesTest, LimbsAreNeverMadeUp) {
  for (int role : {0, 7, 8, 9, 11, 12, 13, 14, 15, 16, 18, 19, 20}) {
    BodyRoles roles = AllRoles();
    roles.joints[role].clear();
    EXPECT_EQ(UnfilledRoles(roles), std::vector<int>{role});
  }
}

}  // namespace
}  // namespace pushid
