// Forecasters after the first frames, their distributions, and what these learn from.
#include "ident/observed/first_frames.h"

#include <gtest/gtest.h>

#include <cmath>

#include "datasets/files/random.h"

namespace pushid {
namespace {

constexpr double kFrame = 1.0 / 60.0;

const HipPaths kPhysics = {HipPath(60, Vector3<double>(0.0, 0.0, 1.0))};
const HipPaths kInput = {HipPath(60, Vector3<double>(1.0, 0.0, 1.0))};

TEST(InputShare, PhysicsHasTheWordFirst) {
  for (double seconds : {0.0, 0.1, 0.24}) {
    EXPECT_EQ(InputShare(0.15, kPhysics, kInput, seconds), 0.0);
  }
  EXPECT_NEAR(*InputShare(0.15, kPhysics, kInput, 0.6), 0.5, 1e-12);
  EXPECT_EQ(InputShare(0.6, kPhysics, kInput, 0.5), 1.0);
  const HipPaths blended = Blended(0.6, kPhysics, kInput);
  EXPECT_NEAR(blended[0][29].x(), 0.6, 1e-12);
  EXPECT_NEAR(blended[0][29].z(), 1.0, 1e-12);
}

TEST(InputShare, IsOfWhoIsThere) {
  EXPECT_EQ(InputShare(0.15, kPhysics, {}, 0.4), 0.0);
  EXPECT_EQ(InputShare(0.15, {}, kInput, 0.1), 1.0);
  EXPECT_EQ(InputShare(0.15, kPhysics, kInput, 0.4, ForecastUse::kPhysics), 0.0);
  EXPECT_EQ(InputShare(0.15, kPhysics, kInput, 0.0, ForecastUse::kInput), 1.0);
  EXPECT_FALSE(InputShare(0.15, kPhysics, {}, 0.4, ForecastUse::kInput));
  EXPECT_EQ(Blended(0.0, kPhysics, {}), kPhysics);
  EXPECT_EQ(Blended(1.0, {}, kInput), kInput);
}

// The two err alike, one to each side: in the middle is the truth.
std::vector<ForecastTrial> PlantedTrials() {
  std::vector<ForecastTrial> trials;
  for (int i = 0; i < 40; ++i) {
    ForecastTrial trial;
    trial.fold = i % 4;
    trial.seconds = 0.1 * (1 + i % 7);
    trial.dt = kFrame;
    trial.axes.setIdentity();
    const HipPath path(40, Vector3<double>(0.3, 0.1, 1.0));
    const Vector3<double> off(i % 2 == 0 ? 0.1 : -0.1, 0.05, 0.0);
    trial.measured = {path};
    trial.seen = {std::vector<bool>(40, true)};
    trial.from = {path[0]};
    trial.physics = {path};
    for (Vector3<double>& hip : trial.physics[0]) hip += off;
    for (size_t k = 0; k < trial.input.size(); ++k) {
      trial.input[k] = {path};
      for (Vector3<double>& hip : trial.input[k][0]) hip -= (k == 1 ? 1.0 : 2.0) * off;
    }
    trials.push_back(trial);
  }
  return trials;
}

// A filter that knows the answers is believed, one that knows nothing is not; of three tails the
// best is taken, and a fold does not teach its own rule.
TEST(LearnForecasts, FindsHowMuchTheFilterIsRight) {
  std::vector<ForecastTrial> right = PlantedTrials(), wrong = right, leaking = right;
  for (ForecastTrial& trial : right) trial.input[2] = trial.measured;
  for (ForecastTrial& trial : wrong) trial.physics = trial.measured;
  for (ForecastTrial& trial : leaking) {
    (trial.fold == 2 ? trial.input[0] : trial.physics) = trial.measured;
  }
  EXPECT_EQ(LearnRule(right).input_time, 0.6);
  EXPECT_EQ(LearnRule(right).tail, kTails[2]);
  EXPECT_EQ(LearnRule(wrong).input_time, 0.0);
  EXPECT_EQ(LearnRule(PlantedTrials()).tail, kTails[1]);
  EXPECT_EQ(LearnRule(PlantedTrials()).input_time, 0.15);  // about the middle of the two
  EXPECT_EQ(LearnRule(leaking, 2).input_time, 0.0);
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
  const std::array<ErrorScale, 3> errors = LearnErrorScales(trials, centre);
  double inside50[3] = {}, inside90[3] = {}, count = 0.0;
  for (size_t i = 0; i < trials.size(); ++i) {
    const HipDistribution hips(errors, trials[i].axes, centre[i], trials[i].from, trials[i].seconds,
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

// CRPS of a normal distribution in closed form (Gneiting and Raftery 2007, (21)).
TEST(HipDistribution, CrpsIsThatOfTheNormalDistribution) {
  std::array<ErrorScale, 3> errors;
  for (ErrorScale& scale : errors) scale.coefficients = {std::log(0.2), 0.0, 0.0, 0.0};
  const HipDistribution hips(errors, Eigen::Matrix3d::Identity(),
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
