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

// Poses that were seen stay; what the restoration misses the last of them by fades from there, and
// a foot that is in the air then is not held.
TEST(PostprocessTest, BeginsWithTheLastPoseSeen) {
  RestorationInput person;
  person.first_pose = StandingPose();
  person.dt = 1.0 / 60.0;
  BodyMotion motion;
  for (int t = 0; t < 40; ++t) {
    Pose pose = person.first_pose;
    const double swing = std::min(1.0, t / 19.0);
    for (int j : {kLeftAnkle, kLeftToe}) {
      pose(0, j) += 0.25 * swing;
      pose(2, j) += 0.06 * std::sin(M_PI * swing);
    }
    if (t < 10) person.seen.push_back(pose);
    motion.push_back(pose.array() + 0.01);  // the restoration is off by a centimetre
  }
  const BodyMotion restored = motion;
  PostprocessOptions options;
  options.keep_bones = false;
  Finish(person, options, &motion);
  for (int t = 0; t < 10; ++t) EXPECT_EQ(motion[t], person.seen[t]) << t;
  for (int t = 10; t < 17; ++t) {
    EXPECT_NEAR(restored[t](1, kBodyHead) - motion[t](1, kBodyHead), 0.01 * (1.0 - (t - 9) / 8.0),
                1e-12)
        << t;
    EXPECT_GT(motion[t](0, kLeftAnkle), motion[t - 1](0, kLeftAnkle) + 0.005) << t;
  }
  EXPECT_NEAR(motion[39](0, kRightAnkle), person.first_pose(0, kRightAnkle), 1e-9);
  EXPECT_GT(motion[39](0, kLeftAnkle), person.first_pose(0, kLeftAnkle) + 0.2);
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

// The left foot steps 0.3 m in frames 20 to 29, the right one 0.2 m in 30 to 39. The restoration
// has both feet slide and bob up and down all the time.
struct SteppingPerson {
  RestorationInput person = WithPendulum(StandingPose(), 80);
  BodyMotion motion;

  SteppingPerson() {
    const Vector4<double> start = person.q[0];
    person.q.clear();
    for (int t = 0; t < 60; ++t) {
      const double done = std::clamp((t - 20) / 20.0, 0.0, 1.0);
      person.q.push_back(start + done * Vector4<double>(0.25, 0.0, 0.0, 0.0));
      FootPath feet;
      for (const bool left : {false, true}) {
        const int first = left ? 20 : 30;
        feet.flies[left] = t >= first && t < first + 10;
        const double swing = std::clamp((t - first + 1) / 11.0, 0.0, 1.0);
        feet.moved[left] = swing * Eigen::Vector2d(left ? 0.3 : 0.2, 0.0);
      }
      person.feet.push_back(feet);
      Pose pose = Placed(StandingPose(), 0.0, {0.25 * done, 0.0, -0.03});
      for (int j : {kRightAnkle, kRightToe, kLeftAnkle, kLeftToe}) {
        pose(0, j) += 0.001 * (t % 20);
        pose(2, j) += 0.03 + 0.02 * std::sin(0.7 * t);
      }
      pose(0, kLeftToe) += 0.02;  // a foot that pitches
      motion.push_back(pose);
    }
    KeepBones(person.first_pose, &motion);
  }
};

TEST(PostprocessTest, FeetAreWhereTheModelHasThem) {
  SteppingPerson s;
  const Pose& first = s.person.first_pose;
  PlantFeet(s.person, &s.motion);
  for (const bool left : {false, true}) {
    const int ankle = left ? kLeftAnkle : kRightAnkle, toe = left ? kLeftToe : kRightToe;
    const int leaves = left ? 20 : 30, lands = leaves + 10;
    const Eigen::Vector3d length(left ? 0.3 : 0.2, 0.0, 0.0);
    for (int j : {ankle, toe}) {
      for (int t = 1; t < leaves; ++t) EXPECT_LT((s.motion[t] - first).col(j).norm(), 1e-9) << t;
      for (int t = lands; t < 60; ++t) {
        EXPECT_LT(((s.motion[t] - first).col(j) - length).norm(), 1e-9) << t;
      }
    }
    double highest = 0.0;
    for (int t = leaves; t < lands; ++t) {
      EXPECT_GT(s.motion[t](2, ankle), first(2, ankle)) << t;
      highest = std::max(highest, s.motion[t](2, ankle) - first(2, ankle));
    }
    EXPECT_GT(highest, 0.045);
  }
  for (int t = 2; t < 60; ++t) {
    EXPECT_LT((s.motion[t] - s.motion[t - 1]).colwise().norm().maxCoeff(), 0.06) << t;
    EXPECT_LT((BoneLengths(s.motion[t]) - BoneLengths(first)).cwiseAbs().maxCoeff(), 1e-9) << t;
  }
}

TEST(PostprocessTest, APlaceThatTheLegDoesNotReachIsLetGo) {
  SteppingPerson s;
  for (FootPath& feet : s.person.feet) feet = s.person.feet[0];
  for (int t = 0; t < 60; ++t) s.motion[t].row(0).array() += 0.03 * t;  // the hip leaves for good
  Finish(s.person, PostprocessOptions(), &s.motion);
  EXPECT_GT(s.motion[59](0, kLeftAnkle), s.person.first_pose(0, kLeftAnkle) + 0.05);
  for (const Pose& pose : s.motion) {
    EXPECT_TRUE(pose.allFinite());
    EXPECT_LT((BoneLengths(pose) - BoneLengths(s.person.first_pose)).cwiseAbs().maxCoeff(), 1e-9);
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
