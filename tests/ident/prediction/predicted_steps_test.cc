// Stepping phases of a path, how they are told, and what lift-offs err.
#include "ident/prediction/predicted_steps.h"

#include <gtest/gtest.h>

namespace pushid {
namespace {

// One person, 0.01 m forwards a frame.
Prediction PathWith(const std::vector<double>& step_states) {
  Prediction prediction;
  prediction.feet_step = true;
  prediction.path = RolloutPath<double>(static_cast<int>(step_states.size()), 1);
  for (int t = 0; t < prediction.path.num_frames(); ++t) {
    prediction.path.At(t, 0).q[0] = 0.01 * t;
    prediction.path.At(t, 0).step = step_states[t];
  }
  return prediction;
}

std::string Text(const Prediction& prediction) {
  PendulumRecording recording;
  recording.subject_ids = {"S01"};
  recording.scene.dt = 0.1;
  return PredictedStepsText(recording, prediction);
}

TEST(PredictedSteps, APhaseFromLiftOffToLanding) {
  Prediction prediction = PathWith({0.0, 0.3, 0.9, 0.95, 0.8, 0.3, 0.1});
  const std::vector<SteppingPhase> phases = SteppingPhases(prediction.path, 0);
  ASSERT_EQ(phases.size(), 1u);
  EXPECT_EQ(phases[0].lift_off, 2);
  EXPECT_EQ(phases[0].landing, 5);
  EXPECT_TRUE(phases[0].finished);
  EXPECT_NEAR(phases[0].travel.x(), 0.03, 1e-15);
  EXPECT_EQ(StandingFrames(prediction, 0),
            std::vector<bool>({true, true, false, false, false, true, true}));
  EXPECT_EQ(Text(prediction), "S01: steps from 0.2 s to 0.5 s, 0.03 m forwards\n");
  prediction.steps = {{0.1, 0.934, 0.01}};
  EXPECT_EQ(Text(prediction), "S01: P(step) 0.93, steps from 0.2 s to 0.5 s, 0.03 m forwards\n");
  prediction.feet_step = false;  // a model that only knows the probability
  EXPECT_EQ(Text(prediction), "S01: P(step) 0.93\n");
  EXPECT_TRUE(StandingFrames(prediction, 0).empty());
}

TEST(PredictedSteps, TheEdgesOfAPath) {
  EXPECT_TRUE(SteppingPhases(RolloutPath<double>(), 0).empty());
  EXPECT_TRUE(SteppingPhases(PathWith({0.0, 0.85, 0.85}).path, 0).empty());
  EXPECT_EQ(Text(PathWith({0.0, 0.0})), "S01: stands\n");
  const Prediction cut_off = PathWith({0.0, 0.87, 0.9});
  const std::vector<SteppingPhase> phases = SteppingPhases(cut_off.path, 0);
  ASSERT_EQ(phases.size(), 1u);
  EXPECT_FALSE(phases[0].finished);
  EXPECT_EQ(phases[0].landing, 3);
  EXPECT_NEAR(phases[0].travel.x(), 0.01, 1e-15);
  EXPECT_EQ(StandingFrames(cut_off, 0), std::vector<bool>({true, false, false}));
  EXPECT_EQ(Text(cut_off), "S01: steps from 0.1 s on, 0.01 m forwards by the end\n");
}

TEST(PredictedSteps, AFlickerIsOnePhaseAndARestPartsTwo) {
  EXPECT_EQ(SteppingPhases(PathWith({0.86, 0.84, 0.86, 0.8, 0.9, 0.0}).path, 0).size(), 1u);
  const Prediction twice = PathWith({0.9, 0.2, 0.9, 0.95});
  EXPECT_EQ(SteppingPhases(twice.path, 0).size(), 2u);
  EXPECT_EQ(Text(twice),
            "S01: steps from 0 s to 0.1 s, 0.01 m forwards; from 0.2 s on, 0.01 m forwards by the "
            "end\n");
}

TEST(PredictedSteps, LiftOffErrorsOfThoseWhoStepInBoth) {
  const auto person = [](std::optional<double> predicted, std::optional<double> recorded) {
    StepPrediction p;
    p.timing = StepTiming();
    p.timing->lift_off = predicted;
    p.timing->recorded_lift_off = recorded;
    return p;
  };
  const LiftOffError error = ScoreSteps({person(0.5, 0.25), person(0.25, 0.75), person(1.0, 0.0),
                                         person(0.5, {}), person({}, 0.5), StepPrediction()})
                                 .lift_off;
  EXPECT_EQ(error.people, 3);
  EXPECT_DOUBLE_EQ(error.median, 0.25);
  EXPECT_DOUBLE_EQ(error.mean_absolute, (0.25 + 0.5 + 1.0) / 3.0);
  EXPECT_EQ(ScoreSteps({StepPrediction()}).lift_off.people, 0);
}

}  // namespace
}  // namespace pushid
