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

// Frames 0-19 stand, 20-39 step 0.3 m forwards and 0.05 m to the left, 40-59 stand. The restoration
// has both feet slide all the time, bob up and down, and end 0.1 m short of the cart.
struct SteppingPerson {
  RestorationInput person = WithPendulum(StandingPose(), 80);
  BodyMotion motion;

  SteppingPerson() {
    const Vector4<double> start = person.q[0];
    person.q.clear();
    for (int t = 0; t < 60; ++t) {
      const double done = std::clamp((t - 20) / 20.0, 0.0, 1.0);
      person.q.push_back(start + done * Vector4<double>(0.3, 0.05, 0.0, 0.0));
      person.stands.push_back(t < 20 || t >= 40);
      Pose pose = Placed(StandingPose(), 0.0, {0.3 * done, 0.05 * done, -0.03});
      for (int j : {kRightAnkle, kRightToe, kLeftAnkle, kLeftToe}) {
        pose(0, j) += 0.001 * (t % 20) - 0.1 * done;
        pose(2, j) += 0.03 + 0.02 * std::sin(0.7 * t);
      }
      pose(0, kLeftToe) += 0.02;  // a foot that pitches
      motion.push_back(pose);
    }
    KeepBones(person.first_pose, &motion);
  }
};

TEST(PostprocessTest, FeetStandAndLandWhereTheModelSays) {
  SteppingPerson s;
  const Pose& first = s.person.first_pose;
  const BodyMotion before = s.motion;
  Finish(s.person, PostprocessOptions(), &s.motion);
  for (int j : {kLeftAnkle, kLeftToe, kRightAnkle, kRightToe}) {
    for (int t = 0; t < 20; ++t) EXPECT_LT((s.motion[t] - first).col(j).norm(), 1e-9) << t;
    for (int t = 41; t < 60; ++t) {
      EXPECT_LT((s.motion[t] - s.motion[40]).col(j).norm(), 1e-9) << t;
    }
    EXPECT_NEAR(s.motion[40](2, j), first(2, j), 1e-9);
  }
  const auto midpoint = [](const Pose& pose) -> Eigen::Vector2d {
    return 0.5 * (pose.col(kLeftAnkle) + pose.col(kRightAnkle)).head<2>();
  };
  const Eigen::Vector2d travel = midpoint(s.motion[40]) - midpoint(first);
  EXPECT_LT((travel - Eigen::Vector2d(0.3, 0.05)).norm(), 1e-9);
  // As far apart as restored; no jump anywhere.
  const auto apart = [](const Pose& pose) -> Eigen::Vector2d {
    return (pose.col(kLeftAnkle) - pose.col(kRightAnkle)).head<2>();
  };
  EXPECT_LT((apart(s.motion[40]) - apart(before[40])).norm(), 1e-9);
  for (int t = 1; t < 60; ++t) {
    EXPECT_LT((s.motion[t] - s.motion[t - 1]).colwise().norm().maxCoeff(), 0.05) << t;
    EXPECT_LT((BoneLengths(s.motion[t]) - BoneLengths(first)).cwiseAbs().maxCoeff(), 1e-9) << t;
  }
}

TEST(PostprocessTest, OneFootStandsWhileTheOtherSteps) {
  SteppingPerson s;
  s.motion.assign(60, s.person.first_pose);
  for (int t = 20; t < 60; ++t) {
    s.person.stands[t] = false;  // to the end
    const double swing = std::min(1.0, (t - 20) / 15.0);
    for (int j : {kLeftAnkle, kLeftToe}) {
      s.motion[t](0, j) += 0.25 * swing;
      s.motion[t](2, j) += 0.08 * std::sin(M_PI * swing);
    }
    for (int j : {kRightAnkle, kRightToe}) s.motion[t](0, j) += 0.001 * (t - 20);
  }
  PlantFeet(s.person, PostprocessOptions(), &s.motion);
  for (int j : {kRightAnkle, kRightToe}) {
    for (int t = 0; t < 60; ++t) {
      EXPECT_LT((s.motion[t] - s.person.first_pose).col(j).norm(), 1e-9) << t;
    }
  }
  EXPECT_NEAR(s.motion[59](0, kLeftAnkle), s.person.first_pose(0, kLeftAnkle) + 0.25, 0.01);
}

TEST(PostprocessTest, APlaceThatTheLegDoesNotReachIsLetGo) {
  SteppingPerson s;
  s.person.stands.assign(60, true);  // the hip leaves for good
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
