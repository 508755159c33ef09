// Forward sensitivities against Jets through the same rollout, in three regimes.
#include "residuals/sensitivities/rollout_sensitivities.h"

#include <ceres/jet.h>

#include <algorithm>

#include "residuals/cost_functions/rollout_problem.h"
#include "tests/residuals/residual_samples.h"

namespace pushid {
namespace {

constexpr int kRolloutFrames = 45;
constexpr int kPeople = 2;
// Natural parameters and initial velocities of both people.
constexpr int kRolloutColumns = kPeople * (kNumParameters + 4);
static_assert(kRolloutColumns % kGramBlock == 0);
using RolloutJet = ceres::Jet<double, kRolloutColumns>;

// How far from rest a rollout is driven.
struct RolloutRegime {
  std::string name;
  double lean;      // rad, at frame 0
  double push;      // N
  double velocity;  // m/s and rad/s, at frame 0
  double spread;    // of the parameters, relative
  double absolute;  // tolerance where a whole column vanishes
};

std::ostream& operator<<(std::ostream& out, const RolloutRegime& regime) {
  return out << regime.name;
}

// Pushes of every kind, two of them on one person, one cut off by the end.
Scene PushedScene(const RolloutRegime& regime, Random* random) {
  Scene scene = SceneOfPeople(kPeople, regime.lean, random);
  scene.pushes = {RandomPush(0, 0, 4, PushKind::kNet, regime.push, random),
                  RandomPush(1, 2, 5, PushKind::kNetWithoutFriction, regime.push, random),
                  RandomPush(0, 14, 6, PushKind::kExternal, 0.7 * regime.push, random),
                  RandomPush(1, 20, 3, PushKind::kNet, 0.5 * regime.push, random),
                  RandomPush(0, kRolloutFrames - 3, 9, PushKind::kExternal, regime.push, random)};
  return scene;
}

// Every natural parameter and velocity of every person is a column of its own.
SensitivityInputs InputsOfEverything(const RolloutRegime& regime, Random* random) {
  SensitivityInputs inputs;
  inputs.num_columns = kRolloutColumns;
  inputs.velocity_column = kPeople * kNumParameters;
  for (int n = 0; n < kPeople; ++n) {
    inputs.parameters.push_back(RandomRecoveringParameters(random, regime.spread));
    // What does not depend on the push is not tiny beside tiny ones.
    inputs.parameters[n][kTailBase] = 1e-3 * std::min(regime.push, 100.0);
    inputs.initial_velocity.push_back(Vector4<double>::Zero());
    inputs.entries.emplace_back();
    for (int i = 0; i < 4; ++i) {
      inputs.initial_velocity[n][i] = random->Uniform(-regime.velocity, regime.velocity);
    }
    for (int i = 0; i < kNumParameters; ++i) {
      inputs.entries[n].push_back({n * kNumParameters + i, static_cast<Parameter>(i), 1.0});
    }
  }
  return inputs;
}

RolloutPath<RolloutJet> RollJets(const Scene& scene, const ModelOptions& options,
                                 const SensitivityInputs& inputs) {
  std::vector<ParameterSet<RolloutJet>> parameters(kPeople);
  std::vector<Vector4<RolloutJet>> velocities(kPeople);
  for (int n = 0; n < kPeople; ++n) {
    for (int i = 0; i < kNumParameters; ++i) {
      parameters[n][i] = RolloutJet(inputs.parameters[n][i], n * kNumParameters + i);
    }
    for (int i = 0; i < 4; ++i) {
      velocities[n][i] =
          RolloutJet(inputs.initial_velocity[n][i], inputs.velocity_column + 4 * n + i);
    }
  }
  RolloutPath<RolloutJet> path;
  EXPECT_TRUE(Rollout(scene, options, parameters, velocities, kRolloutFrames, &path).ok);
  return path;
}

class Sensitivities : public testing::TestWithParam<RolloutRegime> {};

TEST_P(Sensitivities, EqualJetsForEveryModel) {
  const RolloutRegime& regime = GetParam();
  Random random(31);
  for (const ModelOptions& options : EveryModelOptions()) {
    SCOPED_TRACE(Describe(options));
    const Scene scene = PushedScene(regime, &random);
    const SensitivityInputs inputs = InputsOfEverything(regime, &random);
    RolloutPath<double> path;
    RolloutSensitivities sensitivities;
    ASSERT_TRUE(
        RolloutWithSensitivities(scene, options, inputs, kRolloutFrames, &path, &sensitivities).ok);
    const RolloutPath<RolloutJet> jets = RollJets(scene, options, inputs);
    int wrong = 0;
    for (int t = 0; t < kRolloutFrames; ++t) {
      for (int n = 0; n < kPeople; ++n) {
        Eigen::Matrix<double, 8, kRolloutColumns> expected;
        for (int i = 0; i < 4; ++i) {
          expected.row(i) = jets.At(t, n).q[i].v.transpose();
          expected.row(4 + i) = jets.At(t, n).qd[i].v.transpose();
        }
        const auto actual = sensitivities.At(t, n);
        for (int column = 0; column < kRolloutColumns; ++column) {
          // Ankles hold by torques that nearly cancel, of 100 N m against LDP's repulsion: what
          // rounding leaves of them.
          const double cancelled = options.interaction.ldp_published ? 3e-17 : 1e-18;
          const double rounding = options.stance == Stance::kSteps ? cancelled : 0.0;
          const double allowed =
              1e-10 * expected.col(column).cwiseAbs().maxCoeff() + regime.absolute + rounding;
          for (int row = 0; row < 8; ++row) {
            if (std::abs(actual(row, column) - expected(row, column)) <= allowed) continue;
            if (++wrong > 5) continue;
            ADD_FAILURE() << "frame " << t << ", person " << n << ", state " << row << ", column "
                          << column << ": " << actual(row, column) << ", expected "
                          << expected(row, column);
          }
        }
      }
    }
    ASSERT_EQ(wrong, 0);
  }
}

TEST_P(Sensitivities, PathIsThatOfThePlainRolloutToTheLastBit) {
  const RolloutRegime& regime = GetParam();
  Random random(32);
  for (const ModelOptions& options : EveryModelOptions()) {
    SCOPED_TRACE(Describe(options));
    const Scene scene = PushedScene(regime, &random);
    const SensitivityInputs inputs = InputsOfEverything(regime, &random);
    RolloutPath<double> path, plain;
    RolloutSensitivities sensitivities;
    ASSERT_TRUE(
        RolloutWithSensitivities(scene, options, inputs, kRolloutFrames, &path, &sensitivities).ok);
    ASSERT_TRUE(
        Rollout(scene, options, inputs.parameters, inputs.initial_velocity, kRolloutFrames, &plain)
            .ok);
    for (int t = 0; t < kRolloutFrames; ++t) {
      for (int n = 0; n < kPeople; ++n) {
        ASSERT_EQ(path.At(t, n).q, plain.At(t, n).q) << "frame " << t << ", person " << n;
        ASSERT_EQ(path.At(t, n).qd, plain.At(t, n).qd) << "frame " << t << ", person " << n;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(ThreeRegimes, Sensitivities,
                         testing::Values(RolloutRegime{"at_rest", 0.0, 0.0, 0.0, 0.0, 1e-16},
                                         RolloutRegime{"tiny", 0.0, 1e-6, 1e-8, 0.3, 1e-20},
                                         RolloutRegime{"large", 0.1, 150.0, 0.3, 0.4, 1e-14}),
                         [](const auto& test) { return test.param.name; });

TEST(Sensitivities, FirstFrameKnowsTheInitialVelocityOnly) {
  Random random(33);
  const Scene scene = SceneOfPeople(kPeople, 0.05, &random);
  const SensitivityInputs inputs = InputsOfEverything({"", 0.05, 0, 0.1, 0.1, 0}, &random);
  RolloutPath<double> path;
  RolloutSensitivities sensitivities;
  ASSERT_TRUE(RolloutWithSensitivities(scene, {}, inputs, 2, &path, &sensitivities).ok);
  for (int n = 0; n < kPeople; ++n) {
    Eigen::Matrix<double, 8, kRolloutColumns> expected =
        Eigen::Matrix<double, 8, kRolloutColumns>::Zero();
    expected.block<4, 4>(4, inputs.velocity_column + 4 * n).setIdentity();
    EXPECT_EQ(sensitivities.At(0, n), expected);
    // A person's parameters move no other person.
    const int other = (1 - n) * kNumParameters;
    EXPECT_EQ(sensitivities.At(1, n).middleCols(other, kNumParameters).norm(), 0.0);
  }
}

TEST(Sensitivities, FailureNamesFramePersonAndQuantity) {
  Random random(34);
  Scene scene = SceneOfPeople(kPeople, 0.0, &random);
  scene.pushes = {RandomPush(1, 3, 4, PushKind::kExternal, 300.0, &random)};
  SensitivityInputs inputs = InputsOfEverything({"", 0, 0, 0, 0, 0}, &random);
  inputs.parameters[1][kKpTheta] = -2000.0;
  inputs.parameters[1][kKpPhi] = 1e4;
  RolloutPath<double> path, plain;
  RolloutSensitivities sensitivities;
  const RolloutStatus status =
      RolloutWithSensitivities(scene, {}, inputs, 200, &path, &sensitivities);
  const RolloutStatus expected =
      Rollout(scene, {}, inputs.parameters, inputs.initial_velocity, 200, &plain);
  EXPECT_FALSE(status.ok);
  EXPECT_EQ(status.person, 1);
  EXPECT_EQ(status.quantity, "theta");
  EXPECT_GT(status.frame, 4);
  EXPECT_EQ(status.frame, expected.frame);
  EXPECT_EQ(status.quantity, expected.quantity);
  EXPECT_GT(std::abs(path.At(status.frame, 1).q[2]), kMaxAngle);
}

}  // namespace
}  // namespace pushid
