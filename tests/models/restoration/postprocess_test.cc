// Post-processing: residual, bones, feet.
#include "models/restoration/postprocess.h"

#include <gtest/gtest.h>

#include "tests/models/body_samples.h"

namespace pushid {
namespace {

TEST(PostprocessTest, TheResidualFadesOverEightFrames) {
  const Pose first = StandingPose();
  const Pose off = first.array() + 0.08;
  BodyMotion motion(12, off);
  FadeResidual(first, 8, &motion);
  for (int t = 0; t < 12; ++t) {
    const double left = 0.08 * std::min(1.0, t / 8.0);
    EXPECT_LT((motion[t] - first).cwiseAbs().maxCoeff() - left, 1e-12) << t;
    EXPECT_NEAR((motion[t] - first)(1, 7), left, 1e-12) << t;
  }
}

TEST(PostprocessTest, AStandingFootStaysAndALiftedOneGoes) {
  const Pose first = StandingPose();
  BodyMotion motion;
  for (int t = 0; t < 40; ++t) {
    Pose pose = first;
    // Both drift slowly forwards; from frame 20 the left one is swung.
    for (int j : {kRightAnkle, kRightToe}) pose(0, j) += 0.001 * t;
    const double swing = std::max(0, t - 20) / 19.0;
    for (int j : {kLeftAnkle, kLeftToe}) {
      pose(0, j) += 0.001 * t + 0.25 * swing;
      pose(2, j) += 0.06 * std::sin(M_PI * swing);
    }
    motion.push_back(pose);
  }
  const BodyMotion before = motion;
  LockFeet(first, 1.0 / 60.0, PostprocessOptions(), &motion);
  for (int t = 0; t < 40; ++t) {
    EXPECT_NEAR(motion[t](0, kRightAnkle), first(0, kRightAnkle), 1e-9) << t;
    EXPECT_NEAR(motion[t](2, kRightAnkle), before[t](2, kRightAnkle), 1e-9) << t;
  }
  for (int t = 0; t < 20; ++t) {
    EXPECT_NEAR(motion[t](0, kLeftAnkle), first(0, kLeftAnkle), 1e-9) << t;
  }
  // In the air the correction has faded.
  EXPECT_NEAR(motion[30](0, kLeftAnkle), before[30](0, kLeftAnkle), 1e-9);
  EXPECT_GT(motion[39](0, kLeftAnkle), first(0, kLeftAnkle) + 0.2);
}

TEST(PostprocessTest, ALockThatPullsTooFarLetsGo) {
  const Pose first = StandingPose();
  BodyMotion motion;
  for (int t = 0; t < 60; ++t) {
    motion.push_back(Placed(first, 0.0, {0.005 * t, 0.0, 0.0}));  // glides, 0.3 m/s
  }
  LockFeet(first, 1.0 / 60.0, PostprocessOptions(), &motion);
  double largest = 0.0;
  for (int t = 0; t < 60; ++t) {
    largest =
        std::max(largest, std::abs(motion[t](0, kLeftAnkle) - 0.005 * t - first(0, kLeftAnkle)));
  }
  EXPECT_GT(largest, 0.02);
  EXPECT_LE(largest, PostprocessOptions().release_drift + 0.006);
}

TEST(PostprocessTest, FinishKeepsBonesAndTheFirstPose) {
  RestorationInput person = MovingPerson(StandingPose(), 80, 40);
  BodyMotion motion = WindowRestoration(RandomWindow()).Restore({person})[0];
  Finish(person, PostprocessOptions(), &motion);
  EXPECT_LT((motion[0] - person.first_pose).norm(), 1e-9);
  for (const Pose& pose : motion) {
    EXPECT_LT((BoneLengths(pose) - BoneLengths(person.first_pose)).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(PostprocessTest, NothingAskedNothingDone) {
  RestorationInput person = MovingPerson(StandingPose(), 80, 10);
  PostprocessOptions none;
  none.fade_residual = none.keep_bones = none.lock_feet = false;
  BodyMotion motion(10, Pose::Random());
  const BodyMotion before = motion;
  Finish(person, none, &motion);
  for (int t = 0; t < 10; ++t) EXPECT_EQ(motion[t], before[t]);
}

}  // namespace
}  // namespace pushid
