// Percentiles and uniformity where the model is right, and where it is not.
#include "ident/prediction/visual_check.h"

#include <gtest/gtest.h>

#include "tests/ident/effect_samples.h"

namespace pushid {
namespace {

TEST(VisualCheck, UniformityByHand) {
  // Every cluster has one value in each bin: exactly uniform.
  const std::vector<std::vector<double>> even(12, {0.1, 0.3, 0.5, 0.7, 0.9});
  const UniformityTest uniform = TestUniformity(even);
  EXPECT_NEAR(uniform.f, 0.0, 1e-12);
  EXPECT_NEAR(uniform.p, 1.0, 1e-9);
  for (double share : uniform.shares) EXPECT_NEAR(share, 0.2, 1e-12);
  // All in the middle.
  const UniformityTest middle = TestUniformity(std::vector<std::vector<double>>(12, {0.5, 0.45}));
  EXPECT_LT(middle.p, 1e-3);
  EXPECT_EQ(middle.shares[2], 1.0);
}

// Values of one cluster are alike: the test must not take them for independent ones.
TEST(VisualCheck, UniformityKnowsClusters) {
  Random random(3);
  int rejected = 0;
  constexpr int kTrials = 400;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<std::vector<double>> values(32);
    for (auto& cluster : values) cluster.assign(4, random.Unit());
    rejected += TestUniformity(values).p < 0.05;
  }
  EXPECT_LT(rejected, 0.1 * kTrials);
  EXPECT_GT(rejected, 0.005 * kTrials);
}

class PlantedCheck : public ::testing::Test {
 protected:
  PlantedCheck() {
    SyntheticOptions study = SmallStudy();
    study.subjects = 6;
    model_ = TrueModel(study);
    model_.recording_effect = RecordingEffect{};
    model_.recording_effect->spread = 0.4;
    recordings_ = PlantEffects(model_, MakePendulums(study), {0.4, 0.1, 21});
  }
  IdentifiedModel model_;
  std::vector<PendulumRecording> recordings_;
};

TEST_F(PlantedCheck, WhatTheModelDrewLooksRight) {
  const VisualCheck check = CheckVisually(model_, recordings_);
  ASSERT_EQ(check.strata.size(), 3u);  // weak, medium, strong
  for (const CheckedStratum& stratum : check.strata) {
    EXPECT_EQ(stratum.recordings, 12);
    ASSERT_FALSE(stratum.frames.empty());
    EXPECT_GT(stratum.Inside(), 0.6) << stratum.name;
    for (const CheckedFrame& frame : stratum.frames) {
      EXPECT_LT(frame.lower90[1], frame.upper90[1]);
      EXPECT_LE(frame.observed[0], frame.observed[2]);
    }
  }
  EXPECT_GT(check.along.p, 0.01);
  EXPECT_GT(check.across.p, 0.01);
  EXPECT_EQ(check.along.recordings, 36);
}

TEST_F(PlantedCheck, AWrongModelIsSeen) {
  model_.parameters[kTailGain] *= 2.5;
  const VisualCheck check = CheckVisually(model_, recordings_);
  EXPECT_LT(check.along.p, 1e-3);
  EXPECT_TRUE(check.along.Rejects() && !check.along.TooWide());
  double inside = 0.0;
  for (const CheckedStratum& stratum : check.strata) inside += stratum.Inside() / 3.0;
  EXPECT_LT(inside, 0.6);
}

// Noise of the joints does not grow as the errors of real recordings do: intervals are too wide,
// and the model is right.
TEST(VisualCheck, SimulatedRecordingsAreNotRejected) {
  SyntheticOptions study = SmallStudy();
  study.joint_noise_m = 0.002;
  IdentifiedModel model = TrueModel(study);
  const std::vector<PendulumRecording> recordings = MakePendulums(study);
  model.recording_effect = FitRecordingEffect(model, recordings);
  const VisualCheck check = CheckVisually(model, recordings);
  for (const UniformityTest& test : {check.along, check.across}) {
    EXPECT_GT(test.recordings, 0);
    EXPECT_TRUE(test.TooWide());
  }
}

TEST_F(PlantedCheck, NeedsAModelThatSaysHowRecordingsDiffer) {
  EXPECT_TRUE(CheckVisually(model_, {recordings_[0], recordings_[1]}).strata.empty());
  model_.recording_effect.reset();
  EXPECT_TRUE(CheckVisually(model_, recordings_).strata.empty());
}

}  // namespace
}  // namespace pushid
