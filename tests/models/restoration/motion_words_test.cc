// Words of motion: scores by hand, and the exact nearest.
#include <gtest/gtest.h>

#include <numeric>

#include "models/restoration/group_motion.h"
#include "tests/models/body_samples.h"

namespace pushid {
namespace {

BodyMotion Gliding(double speed, int frames, double turn = 0.0) {
  BodyMotion motion;
  for (int t = 0; t < frames; ++t) {
    motion.push_back(
        Placed(StandingPose(), turn, TurnAboutZ(turn) * Eigen::Vector3d(speed * t, 0, 0)));
  }
  return motion;
}

TEST(MotionWordsTest, ScoresByHand) {
  const MotionWords words({Gliding(0.02, 24)});
  EXPECT_EQ(words.size(), 5);
  const auto score = [&words](const BodyMotion& motion) {
    const std::vector<double> scores = words.Scores(motion);
    EXPECT_EQ(scores.size(), motion.size() - kWordFrames + 1);
    return std::accumulate(scores.begin(), scores.end(), 0.0) / static_cast<double>(scores.size());
  };
  EXPECT_NEAR(score(Gliding(0.02, 22, 0.7)), 1.0, 1e-9) << "turned and elsewhere it is the same";
  EXPECT_NEAR(score(Gliding(0.01, 20)), 0.5, 1e-9) << "half as fast";
  EXPECT_NEAR(score(Gliding(-0.02, 20)), 0.0, 1e-9) << "backwards";
  EXPECT_LT(score(Gliding(0.0, 20)), 1e-5) << "not at all";
  EXPECT_TRUE(words.Scores(Gliding(0.02, 19)).empty());
}

// Two joints at rest go nowhere: u.v = 0, both floored to 1e-7 m, so (0 + 1) / 2 * 1.
TEST(MotionWordsTest, RestBesideRestIsNeitherAlikeNorOpposite) {
  const MotionWords words({Gliding(0.0, 20)});
  EXPECT_NEAR(words.Scores(Gliding(0.0, 20))[0], 0.5, 1e-12);
  // One of 17 joints moves by 1 cm a frame, and is unlike what rests.
  BodyMotion nods = Gliding(0.0, 20);
  for (int t = 0; t < 20; ++t) nods[t](2, kWordJoints[0]) += 0.01 * t;
  EXPECT_NEAR(words.Scores(nods)[0], 0.5 * 16.0 / 17.0, 1e-5);
}

// The search by means and axes against looking at every word.
TEST(MotionWordsTest, TheNearestIsExact) {
  Random random(3);
  const auto wobble = [&random]() {
    BodyMotion motion;
    Pose pose = StandingPose(), speed = Pose::Zero();
    for (int t = 0; t < 60; ++t) {
      for (double& x : speed.reshaped()) x = 0.9 * x + 0.004 * random.Normal();
      pose += speed;
      motion.push_back(pose);
    }
    return motion;
  };
  const std::vector<BodyMotion> recorded = {wobble(), wobble(), wobble(), wobble()};
  const MotionWords all(recorded);
  for (int k = 0; k < 5; ++k) {
    const MotionWords::Word word = MotionWords::WordAt(wobble(), 30);
    double least = 1e9;
    for (int i = 0; i < all.size(); ++i) {
      least = std::min(least, (all.word(i) - word).squaredNorm());
    }
    for (const int first : {0, 17, all.size() - 1}) {
      EXPECT_EQ((all.word(all.Nearest(word, first)) - word).squaredNorm(), least);
    }
  }
}

}  // namespace
}  // namespace pushid
