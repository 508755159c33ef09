// The roles of joints, in the skeletons and marker sets of the field.
#include <gtest/gtest.h>

#include "datasets/manifest/joint_mapping.h"
#include "tests/datasets/named_skeletons.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

BodyRoles RolesOf(const BvhSkeleton& skeleton, const JointMapping& mapping = {}) {
  const auto pendulum = Unwrapped(ChoosePendulum("a.bvh", skeleton.Names(), &skeleton, mapping));
  return Unwrapped(ChooseRoles("a.bvh", skeleton.Names(), &skeleton, pendulum, mapping));
}

BodyRoles RolesOfPoints(const std::vector<std::string>& names, const JointMapping& mapping = {}) {
  const auto pendulum = Unwrapped(ChoosePendulum("a.c3d", names, nullptr, mapping));
  return Unwrapped(ChooseRoles("a.c3d", names, nullptr, pendulum, mapping));
}

// "hip=Hips lower_spine=Spine ... left_toe=LeftToeBase"; means with a plus, nothing for no joint.
std::string Played(const BodyRoles& roles, const std::vector<std::string>& names) {
  std::string text;
  for (int role = 0; role < kBodyJoints; ++role) {
    std::string list;
    for (int joint : roles.joints[role]) list += (list.empty() ? "" : "+") + names[joint];
    if (!list.empty()) text += RoleName(role) + "=" + list + " ";
  }
  return text;
}

TEST(RoleChoiceTest, CmuShouldersAreClavicles) {
  const BvhSkeleton skeleton = BvhOf(CmuSkeleton());
  EXPECT_EQ(Played(RolesOf(skeleton), skeleton.Names()),
            "hip=Hips lower_spine=Spine upper_spine=Spine1 neck=Neck head=Head "
            "right_clavicle=RightShoulder right_shoulder=RightArm right_elbow=RightForeArm "
            "right_wrist=RightHand left_clavicle=LeftShoulder left_shoulder=LeftArm "
            "left_elbow=LeftForeArm left_wrist=LeftHand right_hip=RightUpLeg right_knee=RightLeg "
            "right_ankle=RightFoot right_toe=RightToeBase left_hip=LeftUpLeg left_knee=LeftLeg "
            "left_ankle=LeftFoot left_toe=LeftToeBase ")
      << "LowerBack stands where the hip does";
}

TEST(RoleChoiceTest, MixamoIsCmuWithAPrefixAndAThreeJointSpine) {
  std::vector<NamedJoint> joints = CmuSkeleton();
  joints[11] = {"mixamorig:Spine", 0, {0, 0, 1.06}};
  joints[12].name = "mixamorig:Spine1";
  joints[13].name = "mixamorig:Spine2";
  BvhSkeleton skeleton = BvhOf(joints);
  for (BvhJoint& joint : skeleton.joints) {
    if (joint.name.find(':') == std::string::npos) joint.name = "mixamorig:" + joint.name;
  }
  const BodyRoles roles = RolesOf(skeleton);
  EXPECT_TRUE(UnfilledRoles(roles).empty());
  EXPECT_TRUE(FilledRoles(roles).empty());
  EXPECT_EQ(roles.Single(kLowerSpine), 11);
  EXPECT_EQ(roles.Single(kMiddleSpine), 12);
  EXPECT_EQ(roles.Single(kUpperSpine), 13);
  EXPECT_EQ(roles.Single(kLeftClavicle), 17);
}

// Feet that were renamed without it, and are named in the manifest.
TEST(RoleChoiceTest, AnkleWithoutTheSkeletonsPrefix) {
  BvhSkeleton skeleton = BvhOf(CmuSkeleton());
  for (BvhJoint& joint : skeleton.joints) {
    const bool foot = joint.name == "LeftFoot" || joint.name == "RightFoot";
    joint.name = foot ? "my_" + joint.name : "mixamorig:" + joint.name;
  }
  JointMapping mapping;
  mapping.Set(kLeftAnkle, {"my_LeftFoot"});
  mapping.Set(kRightAnkle, {"my_RightFoot"});
  const auto pendulum = Unwrapped(ChoosePendulum("a.bvh", skeleton.Names(), &skeleton, mapping));
  const auto roles = ChooseRoles("a.bvh", skeleton.Names(), &skeleton, pendulum, mapping);
  ASSERT_TRUE(roles.ok());
  EXPECT_TRUE(UnfilledRoles(roles.value()).empty()) << RolesText(roles);
}

TEST(RoleChoiceTest, XsensShouldersAreShoulders) {
  const BvhSkeleton skeleton = BvhOf(XsensSkeleton());
  const BodyRoles roles = RolesOf(skeleton);
  EXPECT_TRUE(FilledRoles(roles).empty());
  EXPECT_TRUE(
      Contains(Played(roles, skeleton.Names()),
               "hip=Hips lower_spine=Chest middle_spine=Chest3 upper_spine=Chest4 neck=Neck "
               "head=Head right_clavicle=RightCollar right_shoulder=RightShoulder "));
}

TEST(RoleChoiceTest, WhatASkeletonLacksIsSaid) {
  const BodyRoles roles = RolesOf(BvhOf(PlainSkeleton()));
  EXPECT_TRUE(UnfilledRoles(roles).empty()) << RoleList(UnfilledRoles(roles));
  EXPECT_EQ(RoleList(FilledRoles(roles)),
            "lower_spine, middle_spine, neck, right_clavicle, left_clavicle, right_toe, left_toe");
  std::vector<NamedJoint> joints = PlainSkeleton();
  joints[11].name = "rig:left middle";
  joints[4].name = "rig:left upper";
  EXPECT_EQ(RoleList(UnfilledRoles(RolesOf(BvhOf(joints)))), "left_shoulder, left_knee");
  EXPECT_EQ(RolesText(RolesOf(BvhOf(joints))), "none: not recognised: left_shoulder, left_knee");
  EXPECT_EQ(RolesText(RolesOf(BvhOf(XsensSkeleton()))), "all roles");
}

TEST(RoleChoiceTest, WhatTheManifestNamesWins) {
  std::vector<NamedJoint> joints = PlainSkeleton();
  joints[11].name = "rig:left middle";
  JointMapping mapping;
  mapping.Set(kLeftKnee, {"rig:left middle"});
  mapping.Set(kUpperSpine, {"", -1, {{"rig:Spine"}, {"", 3}}});
  const BodyRoles roles = RolesOf(BvhOf(joints), mapping);
  EXPECT_EQ(roles.Single(kLeftKnee), 11);
  EXPECT_EQ(roles.joints[kUpperSpine], (std::vector<int>{2, 3}));
  mapping.Set(kLeftKnee, {"knee"});
  const BvhSkeleton skeleton = BvhOf(joints);
  const auto pendulum = ChoosePendulum("a.bvh", skeleton.Names(), &skeleton, {}).value();
  EXPECT_TRUE(
      Contains(ProblemOf(ChooseRoles("a.bvh", skeleton.Names(), &skeleton, pendulum, mapping)),
               "joints: left_knee: there is no joint 'knee'"));
}

// Known by their parents, as their joints have numbers for names.
TEST(RoleChoiceTest, FzjJointsAreTheRoles) {
  BvhSkeleton skeleton;
  for (int j = 0; j < kBodyJoints; ++j) {
    BvhJoint joint;
    joint.name = "joint_" + std::to_string(j);
    joint.parent = kBodyParents[j];
    skeleton.joints.push_back(joint);
  }
  const BodyRoles roles = RolesOf(skeleton);
  for (int role = 0; role < kBodyJoints; ++role) EXPECT_EQ(roles.Single(role), role);
}

TEST(RoleChoiceTest, PlugInGait) {
  const std::vector<std::string> names = {"LFHD", "RFHD", "LBHD", "RBHD", "C7",   "T10",  "CLAV",
                                          "STRN", "RBAK", "LSHO", "LELB", "LWRA", "LWRB", "LFIN",
                                          "RSHO", "RELB", "RWRA", "RWRB", "RFIN", "LASI", "RASI",
                                          "LPSI", "RPSI", "LTHI", "LKNE", "LTIB", "LANK", "LHEE",
                                          "LTOE", "RTHI", "RKNE", "RTIB", "RANK", "RHEE", "RTOE"};
  const BodyRoles roles = RolesOfPoints(names);
  EXPECT_EQ(Played(roles, names),
            "hip=LASI+RASI+LPSI+RPSI upper_spine=T10+STRN neck=C7+CLAV head=LFHD+RFHD+LBHD+RBHD "
            "right_shoulder=RSHO right_elbow=RELB right_wrist=RWRA+RWRB left_shoulder=LSHO "
            "left_elbow=LELB left_wrist=LWRA+LWRB right_knee=RKNE right_ankle=RANK right_toe=RTOE "
            "left_knee=LKNE left_ankle=LANK left_toe=LTOE ");
  EXPECT_TRUE(UnfilledRoles(roles).empty()) << "the pelvis markers give the hip joints";
}

TEST(RoleChoiceTest, OpenSimJointsAndBones) {
  const std::vector<std::string> joints = {
      "pelvis",  "hip_r",         "knee_r",     "ankle_r", "mtp_r",        "hip_l",
      "knee_l",  "ankle_l",       "mtp_l",      "back",    "neck",         "acromial_r",
      "elbow_r", "radius_hand_r", "acromial_l", "elbow_l", "radius_hand_l"};
  EXPECT_TRUE(UnfilledRoles(RolesOfPoints(joints)).empty());
  const std::vector<std::string> bones = {
      "pelvis",   "femur_r", "tibia_r",   "talus_r", "toes_r",    "femur_l",
      "tibia_l",  "talus_l", "toes_l",    "torso",   "humerus_r", "ulna_r",
      "radius_r", "hand_r",  "humerus_l", "ulna_l",  "radius_l",  "hand_l"};
  JointMapping ankles;
  ankles.Set(kLeftAnkle, {"talus_l"});
  ankles.Set(kRightAnkle, {"talus_r"});
  const BodyRoles roles = RolesOfPoints(bones, ankles);
  EXPECT_TRUE(UnfilledRoles(roles).empty()) << RoleList(UnfilledRoles(roles));
  EXPECT_EQ(bones[roles.Single(kLeftWrist - 1)], "ulna_l");
}

// The middle of the hip joints is the hip, and they are themselves all the same.
TEST(RoleChoiceTest, AMeanLeavesItsJointsToOthers) {
  const std::vector<std::string> names = {"LHip", "RHip", "LKnee", "RKnee", "LAnkle", "RAnkle"};
  const BodyRoles roles = RolesOfPoints(names);
  EXPECT_EQ(roles.joints[kBodyHip], (std::vector<int>{0, 1}));
  EXPECT_EQ(roles.Single(kLeftHip), 0);
  EXPECT_EQ(roles.Single(kRightHip), 1);
}

// Two people in one file have joints of their own.
TEST(RoleChoiceTest, PrefixesTellPeopleApart) {
  std::vector<std::string> names;
  for (const char* person : {"Anna:", "Ben:"}) {
    for (const char* name : {"LASI", "RASI", "LPSI", "RPSI", "LANK", "RANK", "LKNE", "RKNE"}) {
      names.push_back(std::string(person) + name);
    }
  }
  JointMapping mapping;
  mapping.Set(kBodyHip, {"", -1, {{"Ben:LASI"}, {"Ben:RASI"}}});
  mapping.Set(kLeftAnkle, {"Ben:LANK"});
  mapping.Set(kRightAnkle, {"Ben:RANK"});
  const BodyRoles roles = RolesOfPoints(names, mapping);
  EXPECT_EQ(names[roles.Single(kLeftKnee)], "Ben:LKNE");
  EXPECT_EQ(names[roles.left_asis[0]], "Ben:LASI");
}

}  // namespace
}  // namespace pushid
