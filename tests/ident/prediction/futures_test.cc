// Drawn futures: proper scores against their closed forms, and draws that are as wide as they say.
#include "ident/prediction/futures.h"

#include <gtest/gtest.h>

#include "ident/fit/fit_setup.h"
#include "ident/fit/step_probability.h"
#include "ident/model/model_rollout.h"
#include "ident/prediction/evaluation.h"
#include "ident/problem/own_axes.h"
#include "ident/problem/statistics.h"
#include "models/rollout.h"
#include "tests/ident/fit_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

TEST(Crps, OfAUniformDistributionIsItsClosedForm) {
  Random random(3);
  std::vector<double> draws;
  for (int i = 0; i < 20000; ++i) draws.push_back(random.Unit());
  // CRPS of U(0, 1): the integral of (F - 1{x >= y})^2.
  for (double y : {-0.5, 0.3, 0.5, 1.2}) {
    const double inside = (y * y * y + (1.0 - y) * (1.0 - y) * (1.0 - y)) / 3.0;
    const double expected = y < 0.0 ? 1.0 / 3.0 - y : y > 1.0 ? y - 1.0 + 1.0 / 3.0 : inside;
    EXPECT_NEAR(Crps(draws, y), expected, 5e-3) << y;
  }
}

TEST(Crps, OfTwoDrawsByHand) {
  EXPECT_DOUBLE_EQ(Crps({0.0, 1.0}, 0.0), 0.0);  // 1/2 - |0 - 1| / 2; with n^2 it were 1/4
  EXPECT_DOUBLE_EQ(Crps({1.0, 0.0, 2.0}, 3.0), 2.0 - 2.0 / 3.0);
}

// Twenty draws are scored as a thousand are, on average.
TEST(Crps, FewDrawsAreNotBiased) {
  Random random(4);
  double few = 0.0, many = 0.0;
  constexpr int kTrials = 400;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<double> draws;
    for (int i = 0; i < 1000; ++i) draws.push_back(random.Normal());
    const double y = random.Normal();
    many += Crps(draws, y) / kTrials;
    draws.resize(20);
    few += Crps(draws, y) / kTrials;
  }
  EXPECT_NEAR(few, many, 0.03);
  EXPECT_NEAR(many, 1.0 / std::sqrt(M_PI), 0.04);  // of N(0, 1) against itself
}

SyntheticOptions NoisyStudy() {
  SyntheticOptions study = TinyStudy();
  study.subjects = 6;
  study.recordings_per_subject = 6;
  study.joint_noise_m = 0.0;
  study.model.process_noise = ProcessNoise::kDiagonal;
  study.parameters[kSigmaX] = 15.0, study.parameters[kSigmaY] = 12.0;
  study.parameters[kSigmaTheta] = 8.0, study.parameters[kSigmaPhi] = 6.0;
  study.parameters[kMeasuredCart] = study.parameters[kMeasuredHip] = 1e-4;
  return study;
}

MeanScore Scored(const SyntheticOptions& study, const IdentifiedModel& model, int draws) {
  return Evaluate(model, MakePendulums(study), 0, UsualGroups(), ForecastUse::kBoth, {draws, 1})
      .model.mean;
}

// Under the truth the bands hold what they say.
TEST(Futures, OfTheTruthHoldWhatTheySay) {
  const MeanScore mean = Scored(NoisyStudy(), TruthOf(NoisyStudy(), BaseTable()), 99);
  EXPECT_NEAR(mean.value[kInside90], 0.9, 0.1);
  EXPECT_NEAR(mean.value[kInside90 + 1], 0.9, 0.1);
  EXPECT_NEAR(mean.value[kInside50], 0.5, 0.12);
  EXPECT_NEAR(mean.value[kInside50 + 1], 0.5, 0.12);
}

// A proper score: other widths than the truth's score worse.
TEST(Futures, TheTruthScoresBest) {
  const auto crps = [](double factor) {
    IdentifiedModel model = TruthOf(NoisyStudy(), BaseTable());
    for (int id = kSigmaX; id <= kSigmaPhi; ++id) model.parameters[id] *= factor;
    return Scored(NoisyStudy(), model, 60).value[kCrps];
  };
  EXPECT_LT(crps(1.0), crps(0.2));
  EXPECT_LT(crps(1.0), crps(4.0));
}

// Feet step in as many draws as P(step) says.
TEST(Futures, OfFeetThatStepHaveTheirProbability) {
  SyntheticOptions study = TinyStudy();
  study.model.stance = Stance::kSteps;
  study.parameters = PublishedStanceParameters();
  IdentifiedModel model = TruthOf(study, BaseTable());
  model.step_probability = StepProbability();
  std::vector<PendulumRecording> recordings = MakePendulums(study);
  model.options.directions = Directions::kBody;
  recordings.front().facing = 0.4;  // pushed aslant
  for (const PendulumRecording& recording : recordings) {
    RolloutPath<double> path;
    ASSERT_TRUE(RolloutInOwnAxes(recording, model.options, PeoplesParameters(model, recording),
                                 recording.num_frames(), &path)
                    .ok);
    const double margin =
        StepMargins(model.options, PeoplesParameters(model, recording), recording, path)[0];
    model.step_probability->coefficients = {1.0 - 20.0 * margin, 20.0};
    const double probability = model.step_probability->At(margin);
    const Futures futures = DrawFutures(model, recording, 300, 1).value();
    ASSERT_EQ(futures.failed, 0);
    double stepped = 0.0;
    for (const std::vector<int>& draw : futures.steps) {
      stepped += draw[0] > 0;
      EXPECT_LE(draw[0], 4) << recording.id;  // nobody marches on the support that was drawn
    }
    EXPECT_NEAR(stepped / 300.0, probability, 0.08) << recording.id << ", margin " << margin;
  }
}

TEST(Futures, WithoutProcessNoiseThereAreNone) {
  SyntheticOptions study = TinyStudy();
  const std::vector<PendulumRecording> recordings = MakePendulums(study);
  EXPECT_TRUE(Contains(ProblemOf(DrawFutures(TruthOf(study, BaseTable()), recordings[0], 10, 1)),
                       "process noise"));
}

}  // namespace
}  // namespace pushid
