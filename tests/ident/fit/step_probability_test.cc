// The logistic regression of stepping on the margin.
#include "ident/fit/step_probability.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "datasets/files/random.h"
#include "datasets/synthetic/synthetic_recordings.h"
#include "ident/model/model_fields.h"
#include "models/rollout.h"

namespace pushid {
namespace {

std::vector<StepOutcome> Drawn(double intercept, double slope, int tracks, uint64_t seed) {
  Random random(seed);
  std::vector<StepOutcome> outcomes;
  for (int i = 0; i < tracks; ++i) {
    StepOutcome outcome;
    outcome.margin = random.Uniform(-0.15, 0.25);
    const double p = 1.0 / (1.0 + std::exp(-(intercept + slope * outcome.margin)));
    outcome.stepped = random.Unit() < p;
    outcome.person = "S" + std::to_string(i % 12);
    outcomes.push_back(outcome);
  }
  return outcomes;
}

TEST(StepProbability, FindsTheCoefficientsThatDrewTheSteps) {
  int within = 0;
  constexpr int kTrials = 40;
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto fitted = FitStepProbability(Drawn(0.5, 25.0, 400, 100 + trial));
    ASSERT_TRUE(fitted.has_value());
    EXPECT_EQ(fitted->clusters, 12);
    const double error = std::sqrt(fitted->covariance(1, 1));
    EXPECT_GT(error, 1.0);
    within += std::abs(fitted->coefficients[1] - 25.0) < 2.2 * error;  // Student's t, 11
  }
  EXPECT_GE(within, 32);
}

// A margin that tells them all apart has no finite likelihood estimate; the prior holds it.
TEST(StepProbability, IsFiniteWhereAllAreToldApart) {
  std::vector<StepOutcome> outcomes;
  for (int i = 0; i < 20; ++i) {
    outcomes.push_back({i < 10 ? -0.1 + 0.005 * i : 0.05 + 0.005 * i, i >= 10, "S"});
  }
  const auto fitted = FitStepProbability(outcomes);
  ASSERT_TRUE(fitted.has_value());
  EXPECT_TRUE(fitted->coefficients.allFinite());
  EXPECT_GT(fitted->At(0.1), 0.95);
  EXPECT_LT(fitted->At(-0.1), 0.05);
  EXPECT_GE(fitted->ErrorAt(0.02), 0.0);
}

TEST(StepProbability, IsFiniteWhereAllDoTheSame) {
  EXPECT_FALSE(FitStepProbability(std::vector<StepOutcome>{}).has_value());
  const auto all = FitStepProbability({{0.1, true, "A"}, {0.2, true, "B"}});
  ASSERT_TRUE(all.has_value());
  EXPECT_GT(all->At(0.15), 0.7);
  const auto none = FitStepProbability({{0.1, false, "A"}, {0.2, false, "B"}});
  ASSERT_TRUE(none.has_value());
  EXPECT_LT(none->At(0.15), 0.3);
}

TEST(StepProbability, SurvivesAFile) {
  const auto fitted = FitStepProbability(Drawn(-0.3, 20.0, 100, 3));
  ASSERT_TRUE(fitted.has_value());
  const StepProbability back = FromJson<StepProbability>(JsonOf(*fitted));
  EXPECT_EQ(back.coefficients, fitted->coefficients);
  EXPECT_EQ(back.covariance, fitted->covariance);
  EXPECT_EQ(back.tracks, 100);
  EXPECT_EQ(back.clusters, 12);
  auto damaged = JsonOf(*fitted);
  damaged["stepped"] = 101;
  EXPECT_THROW(FromJson<StepProbability>(damaged), std::runtime_error);
}

// The factor on a support that has a margin: StepMargin solved for it, which makes it positive.
double FactorAtMargin(double support, double margin) {
  constexpr double kAgainstNone = 1.0 / 500.0;
  const double k = 1.0 - kAgainstNone + margin / support;
  const double root = std::hypot(k, 2.0 * std::sqrt(kAgainstNone));
  return k > 0.0 ? 0.5 * (k + root) : 2.0 * kAgainstNone / (root - k);
}

// Supports are positive: whom nothing moves takes no step, whatever the spread.
TEST(StepProbability, WhomNothingMovesDoesNotStep) {
  for (double factor : {0.002, 0.1, 0.5, 1.0, 3.0}) {
    EXPECT_NEAR(FactorAtMargin(0.1, StepMargin(0.1, factor)), factor, 1e-9 * factor);
  }
  EXPECT_NEAR(StepMargin(0.1, 1.0), 0.0, 1e-12);
  EXPECT_NEAR(StepMargin(0.1, 0.5), -0.05, 1e-3);
  StepProbability p;
  p.coefficients = {0.4, 35.0};  // as in groups
  EXPECT_LT(p.At(StepMargin(0.1, 0.0)), 1e-4);
  EXPECT_GT(FactorAtMargin(0.1, -1.0), 0.0);
}

// At rest the margin is far down; a lean forwards moves it by the hip's way.
TEST(StepProbability, MarginIsTheDistanceBeyondTheSupport) {
  ModelOptions options;
  ParameterSet<double> p{};
  p[kSupportFront] = 0.1, p[kSupportBack] = 0.06, p[kSupportSide] = 0.12;
  ScenePerson person;
  RolloutPath<double> path(3, 1);
  PendulumRecording recording;
  recording.scene.people = {person};
  const auto margin = [&] { return StepMargins(options, {p}, recording, path)[0]; };
  EXPECT_NEAR(margin(), StepMargin(0.1, 0.0), 1e-6);
  path.At(1, 0).q[2] = std::asin(0.15 / kReferenceRod);
  EXPECT_NEAR(margin(), 0.05, 5e-4);
  path.At(1, 0).q[2] = std::asin(-0.15 / kReferenceRod);
  EXPECT_NEAR(margin(), StepMargin(0.1, 0.15 / 0.06), 1e-6);
}

// Feet that step: with a support that is larger by the margin a person just steps no more.
TEST(StepProbability, MarginOfFeetThatStepIsTheirOwn) {
  ModelOptions options;
  options.stance = Stance::kSteps;
  double before = -1.0;
  for (double velocity : {0.1, 0.2, 0.3, 0.4}) {
    PendulumRecording recording;
    recording.scene = SettlingScene(75.0, 75.0 * velocity);
    RolloutPath<double> path;
    const auto steps = [&](const ParameterSet<double>& p) {
      const Scene& scene = recording.scene;
      EXPECT_TRUE(Rollout<double>(scene, options, {p}, InitialVelocities(scene), 180, &path).ok);
      return path.At(path.num_frames() - 1, 0).feet.landed != 0;
    };
    ParameterSet<double> p = PublishedStanceParameters();
    const bool stepped = steps(p);
    const double margin = StepMargins(options, {p}, recording, path)[0];
    EXPECT_GT(margin, before);
    before = margin;
    EXPECT_EQ(margin > 0.0, stepped) << velocity;
    const double factor = FactorAtMargin(p[kSupportFront], margin);
    if (factor < 0.26 || factor > 3.9) continue;
    for (double wider : {0.98, 1.02}) {
      ParameterSet<double> other = p;
      for (Parameter id : {kSupportFront, kSupportBack, kSupportSide}) other[id] *= factor * wider;
      EXPECT_EQ(steps(other), wider < 1.0) << velocity;
    }
  }
}

}  // namespace
}  // namespace pushid
