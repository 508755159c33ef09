// Steps of a path, how they are told, and what lift-offs err.
#include "ident/prediction/predicted_steps.h"

#include <gtest/gtest.h>

#include "models/rollout.h"

namespace pushid {
namespace {

// One person; which foot is in the air, frame by frame: the left one (1), the right one (-1) or
// none. It goes 0.1 m forwards a frame, from that in which it leaves to that in which it lands.
Prediction PathWith(const std::vector<int>& swings) {
  Prediction prediction;
  prediction.feet_step = true;
  prediction.path = RolloutPath<double>(static_cast<int>(swings.size()), 1);
  for (int t = 0; t < prediction.path.num_frames(); ++t) {
    PendulumState<double>& state = prediction.path.At(t, 0);
    const int moves = t == 0 ? 0 : swings[t] != 0 ? swings[t] : swings[t - 1];
    if (t > 0) state = prediction.path.At(t - 1, 0);
    state.q[0] += moves != 0 ? 0.05 : 0.0;
    state.feet.apart[0] += 0.1 * moves;
    state.feet.swings = static_cast<signed char>(swings[t]);
  }
  return prediction;
}

std::string Text(const Prediction& prediction) {
  PendulumRecording recording;
  recording.subject_ids = {"S01"};
  recording.scene.dt = 0.1;
  return PredictedStepsText(recording, prediction);
}

TEST(PredictedSteps, AStepFromLiftOffToLanding) {
  Prediction prediction = PathWith({0, 0, 1, 1, 1, 0, 0});
  const std::vector<FootStep> steps = PredictedSteps(prediction.path, 0);
  ASSERT_EQ(steps.size(), 1u);
  EXPECT_EQ(steps[0].foot, Foot::kLeft);
  EXPECT_EQ(steps[0].lift_off, 2);
  EXPECT_EQ(steps[0].landing, 5);
  EXPECT_TRUE(steps[0].finished);
  EXPECT_NEAR(steps[0].travel.x(), 0.4, 1e-12);
  EXPECT_NEAR(steps[0].travel.y(), 0.0, 1e-12);
  const PendulumState<double>& end = prediction.path.At(6, 0);
  EXPECT_NEAR(PlaceOf(Foot::kLeft, end).x(), 0.4, 1e-12);
  EXPECT_NEAR(PlaceOf(Foot::kRight, end).x(), 0.0, 1e-12);
  EXPECT_EQ(Text(prediction), "S01: steps left 0.2-0.5 s 0.4 m forwards\n");
  prediction.steps = {{0.1, 0.934, 0.01}};
  EXPECT_EQ(Text(prediction), "S01: P(step) 0.93, steps left 0.2-0.5 s 0.4 m forwards\n");
  prediction.feet_step = false;  // a model that only knows the probability
  EXPECT_EQ(Text(prediction), "S01: P(step) 0.93\n");
}

TEST(PredictedSteps, TheEdgesOfAPath) {
  EXPECT_TRUE(PredictedSteps(RolloutPath<double>(), 0).empty());
  EXPECT_EQ(Text(PathWith({0, 0})), "S01: stands\n");
  const Prediction cut_off = PathWith({0, 0, -1, -1});
  const std::vector<FootStep> steps = PredictedSteps(cut_off.path, 0);
  ASSERT_EQ(steps.size(), 1u);
  EXPECT_FALSE(steps[0].finished);
  EXPECT_EQ(steps[0].landing, 4);
  EXPECT_EQ(steps[0].foot, Foot::kRight);
  EXPECT_EQ(PredictedSteps(PathWith({0, 1, 1, 0, -1, -1, 0}).path, 0).size(), 2u);
}

// The left foot goes from 0 to 0.4 m, the right one stays; then the right one leaves for good.
TEST(PredictedSteps, FootprintsFromLandingToLiftOff) {
  const Prediction prediction = PathWith({0, 0, 1, 1, 1, 0, 0, -1});
  PendulumRecording recording;
  const FootprintsOfPeople people = PredictedFootprints(recording, prediction);
  ASSERT_EQ(people.size(), 1u);
  ASSERT_EQ(people[0].size(), 3u);
  const auto expect = [&](int i, Foot foot, int landing, int lift_off, double x) {
    const Footprint& print = people[0][i];
    EXPECT_EQ(print.foot, foot);
    EXPECT_EQ(print.landing, landing);
    EXPECT_EQ(print.lift_off, lift_off);
    EXPECT_NEAR(print.place.x(), x, 1e-12);
    EXPECT_NEAR(print.place.y(), foot == Foot::kLeft ? 0.5 * kFeetApart : -0.5 * kFeetApart, 1e-12);
  };
  expect(0, Foot::kLeft, 0, 2, 0.0);
  expect(1, Foot::kRight, 0, 7, 0.0);
  expect(2, Foot::kLeft, 5, 8, 0.4);
  Prediction seen = prediction;
  seen.observed = 2;
  EXPECT_TRUE(PredictedFootprints(recording, seen).empty()) << "bodies follow the feet seen";
  seen = prediction;
  seen.feet_step = false;
  EXPECT_TRUE(PredictedFootprints(recording, seen).empty());
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
