// Bodies taken back to the skeletons they came from, and written in them.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "datasets/loading/load_recordings.h"
#include "ident/bodies/body_recording.h"
#include "ident/prediction/prediction.h"
#include "models/restoration/restoration.h"
#include "tests/datasets/named_skeletons.h"
#include "tests/datasets/raw_bvh.h"
#include "tests/datasets/recording_folder.h"
#include "tests/models/body_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

constexpr double kScale = 0.0564;  // m in one of the file's lengths

class BodySkeletonTest : public RecordingFolderTest {
 protected:
  // One person of such a skeleton who is carried forward, all joints but the root's turned by 5
  // degrees about the file's z axis (to the side).
  BodyRecording Recorded(const std::vector<NamedJoint>& joints,
                         const std::vector<GroundPose>& ground = {}) {
    std::vector<Eigen::Vector3d> roots;
    for (int t = 0; t < 20; ++t) {
      roots.push_back(joints[0].place + Eigen::Vector3d(0.01 * t, 0.002 * t, 0.0));
    }
    WriteBvhFile("a.bvh", MotionOf(joints, roots, kScale, 5.0), LengthUnit::kMetre);
    entry().push_csv = "";
    entry().up = "y";
    entry().forward = "z";
    entry().length.length_scale = kScale;
    LoadOptions options;
    options.keep_all_joints = true;
    const auto loaded = Unwrapped(Load(options));
    recorded_ = loaded[0].people[0];
    Recording recording = loaded[0];
    recording.ground = ground;
    return Unwrapped(MakeBodyRecording(recording));
  }

  // Joints of a file that was written in the source's own axes and lengths, m, world.
  std::vector<std::vector<Eigen::Vector3d>> ReadBack(const std::string& name) {
    entry().motion = {name};
    LoadOptions options;
    options.keep_all_joints = true;
    return Unwrapped(Load(options))[0].people[0].joints;
  }

  RecordedPerson recorded_;
};

// On ground that moves, bodies are where the ground sees them, as pendulums are; the laboratory
// sees them where they were recorded.
TEST_F(BodySkeletonTest, BodiesStandInTheFrameOfTheirPendulums) {
  std::vector<GroundPose> ground;
  for (int t = 0; t < 20; ++t) ground.emplace_back(0.01 * t, -0.02 * t, 0.01 * t, 0.005 * t);
  const BodyRecording recording = Recorded(PlainSkeleton(), ground);
  std::vector<BodyMotion> bodies = recording.bodies;
  for (int t = 0; t < 20; ++t) {
    EXPECT_LT((bodies[0][t].col(kBodyHip) - recording.pendulum.hip[0][t]).norm(), 1e-9) << t;
  }
  ToLaboratory(recording.pendulum.scene, &bodies);
  for (int t = 0; t < 20; ++t) {
    const Pose seen = PoseOf(recorded_.roles, recorded_.joints[t]);
    EXPECT_LT((bodies[0][t] - seen).norm(), 1e-9) << t;
  }
}

// The hip moves by m: so does every joint, whether it plays a role or not, and the file that is
// written is the source's in all but the numbers of its frames.
TEST_F(BodySkeletonTest, WhoIsCarriedIsCarriedWithAllTheirJoints) {
  for (const auto& joints : {CmuSkeleton(), XsensSkeleton(), PlainSkeleton()}) {
    const BodyRecording recording = Recorded(joints);
    const Eigen::Vector3d move(0.3, -0.1, 0.02);
    BodyMotion motion(4, recording.bodies[0][0]);
    motion[3].colwise() += move;
    const BodySkeleton& skeleton = recording.skeletons[0];
    const FittedTree still = Retarget(skeleton, motion[0]), moved = Retarget(skeleton, motion[3]);
    ASSERT_EQ(skeleton.num_joints(), static_cast<int>(joints.size()));
    for (int j = 0; j < skeleton.num_joints(); ++j) {
      EXPECT_LT((still.positions.col(j) - recorded_.joints[0][j]).norm(), 1e-9) << joints[j].name;
      EXPECT_LT((moved.positions.col(j) - recorded_.joints[0][j] - move).norm(), 1e-9);
      EXPECT_TRUE(moved.rotations[j].isIdentity(1e-7)) << joints[j].name;
    }
    const auto files = WriteBodyBvh(Path("out.bvh"), SceneOf(recording, {motion}));
    ASSERT_TRUE(files.ok()) << files.error().ToString();
    const auto source = ReadBvh(Path("a.bvh")), out = ReadBvh(Path("out.bvh"));
    ASSERT_TRUE(out.ok()) << out.error().ToString();
    ASSERT_EQ(out.value().num_frames(), 4);
    const auto &was = source.value().skeleton.joints, &is = out.value().skeleton.joints;
    ASSERT_EQ(is.size(), was.size());
    for (std::size_t j = 0; j < was.size(); ++j) {
      EXPECT_EQ(is[j].name, was[j].name);
      EXPECT_EQ(is[j].parent, was[j].parent);
      EXPECT_EQ(is[j].offset, was[j].offset);
      EXPECT_EQ(is[j].channels, was[j].channels);
      EXPECT_EQ(is[j].end_sites, was[j].end_sites);
    }
    for (int c = 0; c < source.value().skeleton.num_channels(); ++c) {
      EXPECT_NEAR(out.value().values[c], source.value().values[c], 1e-6)
          << "the first frame, " << c;
    }
    const auto back = ReadBack("out.bvh");
    entry().motion = {"a.bvh"};
    for (int j = 0; j < skeleton.num_joints(); ++j) {
      EXPECT_LT((back[3][j] - recorded_.joints[0][j] - move).norm(), 1e-9) << joints[j].name;
    }
  }
}

// A knee bends by hand: what hangs on the elbow, ankle and hand without a role goes along.
TEST_F(BodySkeletonTest, JointsWithoutARoleFollowTheirParent) {
  const BodyRecording recording = Recorded(CmuSkeleton());
  const BodySkeleton& skeleton = recording.skeletons[0];
  Pose pose = recording.bodies[0][0];
  const auto index = [&](const std::string& name) {
    const auto at = std::find(skeleton.names.begin(), skeleton.names.end(), name);
    EXPECT_NE(at, skeleton.names.end()) << name;
    return static_cast<int>(at - skeleton.names.begin());
  };
  // The forearm turns forward about the elbow, and the hand with its thumb.
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(-0.8, Eigen::Vector3d::UnitY()).toRotationMatrix();
  pose.col(kLeftWrist) =
      pose.col(kLeftWrist - 1) + turn * (pose.col(kLeftWrist) - pose.col(kLeftWrist - 1));
  const FittedTree posed = Retarget(skeleton, pose);
  const int elbow = index("LeftForeArm"), hand = index("LeftHand"), thumb = index("LThumb");
  const auto rest = [&](int j) { return Eigen::Vector3d(skeleton.rest.col(j)); };
  EXPECT_LT((posed.positions.col(hand) - pose.col(kLeftWrist)).norm(), 1e-12);
  EXPECT_LT((posed.rotations[hand] - posed.rotations[elbow]).norm(), 1e-12);
  EXPECT_LT((posed.positions.col(thumb) - posed.positions.col(hand) -
             posed.rotations[elbow] * (rest(thumb) - rest(hand)))
                .norm(),
            1e-12);
  EXPECT_GT((posed.positions.col(thumb) - rest(thumb)).norm(), 0.1);
  EXPECT_LT((posed.positions.col(index("RightHand")) - rest(index("RightHand"))).norm(), 1e-9);
  EXPECT_LT((posed.positions.col(index("Neck1")) - rest(index("Neck1"))).norm(), 1e-9);
}

// What bones of constant length can do comes back from the file: a whole body turned and bent.
TEST_F(BodySkeletonTest, ABentBodyComesBackFromItsFile) {
  const BodyRecording recording = Recorded(XsensSkeleton());
  const Pose first = recording.bodies[0][0];
  Pose bent = first;
  ReachWithLeg(true, first.col(kLeftAnkle) + Eigen::Vector3d(0.2, 0.05, 0.15), &bent);
  BodyMotion motion = {first, FitSkeleton(first, Placed(bent, 0.4, {0.1, 0, 0})).positions};
  ASSERT_TRUE(WriteBodyBvh(Path("out.bvh"), SceneOf(recording, {motion})).ok());
  const BodySkeleton& skeleton = recording.skeletons[0];
  // Loading takes three frames.
  motion.push_back(motion.back());
  ASSERT_TRUE(WriteBodyBvh(Path("out.bvh"), SceneOf(recording, {motion})).ok());
  const auto back = ReadBack("out.bvh");
  for (int j = 0; j < skeleton.num_joints(); ++j) {
    if (skeleton.roles[j] < 0) continue;
    EXPECT_LT((back[1][j] - motion[1].col(skeleton.roles[j])).norm(), 1e-4) << skeleton.names[j];
  }
  EXPECT_GT((back[1][20] - back[0][20]).norm(), 0.1) << "the left knee moved";
}

// Bones are those of the frame that the recording starts with.
TEST_F(BodySkeletonTest, TheRestIsTheFirstFrameThatIsUsed) {
  entry().first_frame = 3;
  const BodyRecording recording = Recorded(CmuSkeleton());
  EXPECT_EQ(recording.num_frames(), 17);
  const BodySkeleton& skeleton = recording.skeletons[0];
  for (int j = 0; j < skeleton.num_joints(); ++j) {
    EXPECT_LT((skeleton.rest.col(j) - recorded_.joints[0][j]).norm(), 1e-12);
  }
  EXPECT_NEAR(skeleton.hip.x(), 0.03, 1e-12);
}

// A hip that is the mean of several joints: the root stands in for it.
TEST_F(BodySkeletonTest, AHipBetweenTwoJoints) {
  entry().joints.Set(kBodyHip, JointReference{"", -1, {{"rig:thigh.L"}, {"rig:thigh.R"}}});
  const BodyRecording recording = Recorded(PlainSkeleton());
  const BodySkeleton& skeleton = recording.skeletons[0];
  const Eigen::Vector3d move(0.3, -0.1, 0.02);
  const FittedTree moved = Retarget(skeleton, recording.bodies[0][0].colwise() + move);
  for (int j = 0; j < skeleton.num_joints(); ++j) {
    EXPECT_LT((moved.positions.col(j) - recorded_.joints[0][j] - move).norm(), 1e-9);
  }
}

TEST_F(BodySkeletonTest, TheFilledIsSaidAndTheUnknownIsAnError) {
  Recorded(PlainSkeleton());
  ASSERT_EQ(warnings_.size(), 1u);
  EXPECT_TRUE(
      Contains(warnings_[0].text, "a.bvh has no joints for lower_spine, middle_spine, neck, "));
  std::vector<NamedJoint> joints = PlainSkeleton();
  joints[11].name = "rig:left middle";
  WriteBvhFile("a.bvh",
               MotionOf(joints, std::vector<Eigen::Vector3d>(5, Eigen::Vector3d::Zero()), kScale),
               LengthUnit::kMetre);
  WritePush("a.csv", 3);
  LoadOptions options;
  options.keep_all_joints = true;
  const auto loaded = Unwrapped(Load(options));
  EXPECT_TRUE(warnings_.empty()) << "there is no body to fill";
  const std::string made = ProblemOf(MakeBodyRecording(loaded[0]));
  EXPECT_TRUE(Contains(made, Path("a.bvh") + ": recording a"));
  EXPECT_TRUE(Contains(made, "not recognised: left_knee; name them"));
  EXPECT_TRUE(Contains(made, "\"joints\": {\"left_knee\": ...}"));
  EXPECT_TRUE(Contains(made, "rig:left middle"));
}

// A knee of one axis gets the other two behind it, a joint without any role keeps its angles.
TEST_F(BodySkeletonTest, HingesGetTheAxesThatTheyLack) {
  BvhMotion motion =
      MotionOf(PlainSkeleton(), std::vector<Eigen::Vector3d>(5, Eigen::Vector3d::Zero()), kScale);
  motion.skeleton.joints[11].channels = {BvhChannel::kXrotation};
  motion.values.clear();
  for (int t = 0; t < 5; ++t) {
    for (int c = 0; c < motion.skeleton.num_channels(); ++c) motion.values.push_back(0.0);
  }
  WriteBvhFile("a.bvh", motion, LengthUnit::kMetre);
  WritePush("a.csv", 3);
  entry().up = "y";
  entry().forward = "z";
  entry().length.length_scale = kScale;
  LoadOptions options;
  options.keep_all_joints = true;
  const auto loaded = Unwrapped(Load(options));
  const auto made = Unwrapped(MakeBodyRecording(loaded[0]));
  const BvhMotion out = ToBvh(made.skeletons[0], made.bodies[0], 1.0 / 60.0);
  EXPECT_EQ(out.skeleton.joints[11].channels,
            (std::vector<BvhChannel>{BvhChannel::kXrotation, BvhChannel::kZrotation,
                                     BvhChannel::kYrotation}));
  EXPECT_EQ(out.num_frames(), 5);
}

}  // namespace
}  // namespace pushid
