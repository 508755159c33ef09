// Forecasts put together: weights, kinematic forecasters, distributions, and what they learn from.
#include "ident/observed/forecast_stack.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "ident/observed/learn_forecasts.h"

namespace pushid {
namespace {

constexpr double kFrame = 1.0 / 60.0;

SeenPath Quadratic(int frames) {
  SeenPath path;
  for (int t = 0; t < frames; ++t) {
    const double s = t * kFrame;
    path.hip.emplace_back(0.5 * s + 0.4 * s * s, -0.2 * s, 1.0);
    path.seen.push_back(true);
  }
  return path;
}

TEST(Kinematics, GoOnWithTheMeanVelocity) {
  const HipPath on = GoesOn(Quadratic(20), 3 * kFrame, kFrame, 10);
  const double s = 19 * kFrame, before = 16 * kFrame;
  const double velocity = 0.5 + 0.4 * (s + before);
  EXPECT_NEAR(on[9].x(), 0.5 * s + 0.4 * s * s + 10 * kFrame * velocity, 1e-12);
  EXPECT_NEAR(on[9].y(), -0.2 * (s + 10 * kFrame), 1e-12);
}

TEST(Kinematics, AQuadraticFades) {
  const HipPath on = GoesOnAccelerating(Quadratic(20), kFrame, 40);
  double place = 0.5 * 19 * kFrame + 0.4 * std::pow(19 * kFrame, 2),
         velocity = 0.5 + 0.8 * 19 * kFrame, acceleration = 0.8;
  for (int t = 0; t < 40; ++t) {
    velocity += kFrame * (acceleration - velocity);
    acceleration *= std::exp(-kFrame / 0.25);
    place += kFrame * velocity;
    EXPECT_NEAR(on[t].x(), place, 1e-9) << t;
  }
}

// Frames that were not seen may say anything, the last one too.
TEST(Kinematics, LookAtNothingUnseen) {
  SeenPath gap = Quadratic(20);
  for (int t : {12, 18, 19}) {
    gap.seen[t] = false;
    gap.hip[t].setConstant(7.0);
  }
  SeenPath end = Quadratic(18);
  end.seen[12] = false;
  EXPECT_NEAR(
      (GoesOnAccelerating(gap, kFrame, 5)[0] - GoesOnAccelerating(end, kFrame, 7)[2]).norm(), 0.0,
      1e-9);
  EXPECT_NEAR((GoesOn(gap, kFrame, kFrame, 5)[0] - GoesOn(end, kFrame, kFrame, 7)[2]).norm(), 0.0,
              1e-9);
  const SeenPath first = Quadratic(1);
  EXPECT_EQ(GoesOnAccelerating(first, kFrame, 3)[2], first.hip[0]);
}

TEST(ForecastWeights, AreSharesOfThoseWhoSpeak) {
  const auto logits = ForecastStack::DefaultLogits();
  for (double seconds : {0.02, 0.2, 0.7}) {
    for (double ahead : {0.02, 0.5, 2.0}) {
      const ForecastWeights all = WeightsOf(logits, {true, true, true, true}, seconds, ahead);
      EXPECT_NEAR(std::accumulate(all.begin(), all.end(), 0.0), 1.0, 1e-12);
      EXPECT_GT(*std::min_element(all.begin(), all.end()), 0.0);
      const ForecastWeights some = WeightsOf(logits, {true, false, true, false}, seconds, ahead);
      EXPECT_EQ(some[1], 0.0);
      EXPECT_NEAR(some[0] + some[2], 1.0, 1e-12);
    }
  }
}

ForecastsOfAll Forecasts() {
  ForecastsOfAll all;
  for (int c = 0; c < kNumForecasters; ++c) {
    all[c] = {HipPath(10, Vector3<double>(c, 0.0, 1.0))};
  }
  return all;
}

TEST(ForecastWeights, OfFrameZeroAloneArePhysics) {
  for (const ForecastWeights& w : WeightsAhead(ForecastStack{}, Forecasts(), 0.0, kFrame)) {
    EXPECT_EQ(w[0], 1.0);
  }
  const auto input = WeightsAhead(ForecastStack{}, Forecasts(), 0.2, kFrame, ForecastUse::kInput);
  EXPECT_EQ(Stacked(input, Forecasts())[0][3].x(), 1.0);
  ForecastsOfAll none = Forecasts();
  none[1].clear();
  EXPECT_TRUE(WeightsAhead(ForecastStack{}, none, 0.2, kFrame, ForecastUse::kInput).empty());
}

// Two err alike, one to each side: in the middle is the truth. The others are far away.
std::vector<ForecastTrial> PlantedTrials() {
  std::vector<ForecastTrial> trials;
  Random random(3);
  for (int i = 0; i < 40; ++i) {
    ForecastTrial trial;
    trial.fold = i % 4;
    trial.seconds = 0.1 * (1 + i % 7);
    trial.dt = kFrame;
    trial.axes.setIdentity();
    const HipPath path(40, Vector3<double>(0.3, 0.1, 1.0));
    const Vector3<double> off(0.1 * random.Normal(), 0.05 * random.Normal(), 0.0);
    trial.measured = {path};
    trial.seen = {std::vector<bool>(40, true)};
    trial.from = {path[0]};
    const Vector3<double> by[] = {off, -off, Vector3<double>(0.5, 0.5, 0.0),
                                  Vector3<double>(-0.6, 0.4, 0.0)};
    for (int c = 0; c < kNumForecasters; ++c) {
      trial.forecasts[c] = {path};
      for (Vector3<double>& hip : trial.forecasts[c][0]) hip += by[c];
    }
    trials.push_back(trial);
  }
  return trials;
}

TEST(LearnForecasts, FindsWhoIsRightTogether) {
  const auto logits = LearnLogits(PlantedTrials());
  const ForecastWeights w = WeightsOf(logits, {true, true, true, true}, 0.4, 0.4);
  EXPECT_NEAR(w[0], 0.5, 0.12);
  EXPECT_NEAR(w[1], 0.5, 0.12);
  EXPECT_LT(w[2] + w[3], 0.1);
}

// A forecaster that knows the answers of one fold, as a model does of what it was fitted to, gets
// no more weight on that fold: weights are learned on the others. With the fold it would.
TEST(LearnForecasts, AFoldDoesNotTeachItsOwnWeights) {
  std::vector<ForecastTrial> leaking = PlantedTrials();
  for (ForecastTrial& trial : leaking) {
    if (trial.fold == 2) trial.forecasts[2] = trial.measured;
  }
  EXPECT_EQ(LearnLogits(leaking, 2), LearnLogits(PlantedTrials(), 2));
  EXPECT_NE(LearnLogits(leaking), LearnLogits(PlantedTrials()));
}

// Errors of known scale: their 50 and 90 % bands hold as many.
TEST(LearnForecasts, ScalesHoldTheirShares) {
  std::vector<ForecastTrial> trials = PlantedTrials();
  std::vector<HipPaths> centre;
  Random random(4);
  for (ForecastTrial& trial : trials) {
    centre.push_back(trial.measured);
    for (size_t t = 0; t < 40; ++t) {
      const double ahead = (t + 1.0) * kFrame;
      for (int i = 0; i < 3; ++i) {
        centre.back()[0][t][i] += 0.2 * ahead * (i == 0 ? 1.0 : 0.3) * random.Normal();
      }
    }
  }
  ForecastStack stack;
  stack.errors = LearnErrorScales(trials, centre);
  double inside50[3] = {}, inside90[3] = {}, count = 0.0;
  for (size_t i = 0; i < trials.size(); ++i) {
    const HipDistribution hips(stack, trials[i].axes, centre[i], trials[i].from, trials[i].seconds,
                               kFrame);
    for (int t = 0; t < 40; ++t, count += 1.0) {
      for (int axis = 0; axis < 3; ++axis) {
        const double share = hips.Cdf(0, t, axis, trials[i].measured[0][t][axis]);
        inside50[axis] += std::abs(share - 0.5) < 0.25;
        inside90[axis] += std::abs(share - 0.5) < 0.45;
      }
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(inside50[axis] / count, 0.5, 0.05) << axis;
    EXPECT_NEAR(inside90[axis] / count, 0.9, 0.03) << axis;
  }
}

// Of a normal distribution in closed form (Gneiting and Raftery 2007, (21)).
TEST(HipDistribution, CrpsIsThatOfTheNormalDistribution) {
  ForecastStack stack;
  for (ErrorScale& scale : stack.errors) scale.coefficients = {std::log(0.2), 0.0, 0.0, 0.0};
  const HipDistribution hips(stack, Eigen::Matrix3d::Identity(),
                             {HipPath(3, Vector3<double>(1.0, 0.0, 0.0))},
                             {Vector3<double>(1.0, 0.0, 0.0)}, 0.2, kFrame);
  for (double value : {1.0, 1.1, 1.4, 0.3}) {
    const double z = (value - 1.0) / 0.2;
    const double below = 0.5 * std::erfc(-z / std::sqrt(2.0));
    const double expected =
        0.2 * (z * (2.0 * below - 1.0) + 2.0 * std::exp(-0.5 * z * z) / std::sqrt(2.0 * M_PI) -
               1.0 / std::sqrt(M_PI));
    EXPECT_NEAR(hips.Crps(0, 1, 0, value), expected, 0.02 * expected + 1e-3) << value;
  }
}

}  // namespace
}  // namespace pushid
