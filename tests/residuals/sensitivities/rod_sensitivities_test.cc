// Rollouts with a rod that moves: derivatives by hand against Jets, for every law, alone and
// beside a learned self force, in three regimes.
#include "residuals/cost_functions/rest_residual.h"
#include "residuals/sensitivities/network_sensitivities.h"
#include "tests/residuals/learned_pair.h"

namespace pushid {
namespace {

struct Learned {
  RodShape rod;
  NetworkShape self;
};

std::vector<Learned> EveryLearned() {
  const RodShape linear{RodKind::kLinear, {}}, mlp{RodKind::kMlp, {3}}, deep{RodKind::kMlp, {3, 2}};
  return {{linear, {}},
          {mlp, {}},
          {deep, {}},
          {linear, {NetworkKind::kMlp, 2}},
          {mlp, {NetworkKind::kGru, 2}},
          {mlp, {NetworkKind::kLstm, 2, 3}},
          {{RodKind::kLdp, {3, 2}}, {}},
          {{RodKind::kLdp, {3}}, {NetworkKind::kLdp, 2, 3}}};
}

std::string LawName(const Learned& learned) {
  return "rod " + RodName(learned.rod) + ", self force " + NetworkName(learned.self);
}

ModelOptions With(const Learned& learned, double size, Random* random) {
  return WithNetwork(learned.self, size, random, learned.rod);
}

class RodTwins : public testing::TestWithParam<Regime> {};

TEST_P(RodTwins, DerivativesByHandEqualJets) {
  const Regime& regime = GetParam();
  Random random(81);
  const ParameterMap map = EveryParameterMap({kMu, kAx, kRodLift});
  for (const Learned& learned : EveryLearned()) {
    for (PushUse use : {PushUse::kAdded, PushUse::kAsRecorded}) {
      for (CartDerivative derivative : {CartDerivative::kNone, CartDerivative::kBackward}) {
        SCOPED_TRACE(LawName(learned));
        ModelOptions options = With(learned, regime.weight, &random);
        options.push = use;
        options.cart_derivative = derivative;
        options.interaction.spring = true;
        ExpectDerivativesEqualJets(options, map, regime, &random);
        if (HasFailure()) return;
      }
    }
  }
}

// Tiny: derivatives by a layer's b are differences of numbers of order 1, good to 1e-16 once scaled
// to an acceleration and two steps; all others are of order 1e-10 and more.
INSTANTIATE_TEST_SUITE_P(ThreeRegimes, RodTwins,
                         testing::Values(Regime{"at_rest", 0.0, 0.0, 0.0, 0.0, 0.5, 1e-14},
                                         Regime{"tiny", 0.0, 1e-6, 1e-8, 1e-8, 0.5, 2e-16},
                                         Regime{"large", 0.1, 150.0, 0.3, 0.05, 1.0, 1e-13}),
                         [](const auto& test) { return test.param.name; });

// The same path as without derivatives, to the last bit, and the rod is part of it.
TEST(RodSensitivities, PathIsTheRollouts) {
  Random random(82);
  for (const Learned& learned : EveryLearned()) {
    const ModelOptions options = With(learned, 0.8, &random);
    const PendulumRecording recording = LearnedPair(options, 0.1, 150.0, 0.0, &random);
    SensitivityInputs inputs;
    inputs.parameters.assign(2, RecoveringParameters());
    inputs.initial_velocity = InitialVelocities(recording.scene);
    inputs.entries.resize(2);
    inputs.num_columns = 8;
    inputs.velocity_column = 0;
    RolloutPath<double> path;
    RolloutSensitivities sensitivities;
    ASSERT_TRUE(RolloutWithSensitivities(recording.scene, options, inputs, kPairFrames, &path,
                                         &sensitivities)
                    .ok);
    for (int t = 0; t < kPairFrames; ++t) {
      for (int n = 0; n < 2; ++n) {
        EXPECT_EQ(path.At(t, n).q, recording.states[n][t].q);
        EXPECT_EQ(path.At(t, n).rod, recording.states[n][t].rod);
        EXPECT_EQ(sensitivities.Rod(t, n).size(), 8);
      }
    }
    EXPECT_NE(path.At(kPairFrames - 1, 0).rod, 0.0) << LawName(learned);
  }
}

// Weights that a fit does not move are those of the model.
TEST(RodSensitivities, FixedWeightsAreTheModels) {
  Random random(83);
  for (const Learned& learned : EveryLearned()) {
    ExpectFixedWeightsAreTheModels(With(learned, 0.8, &random), &random);
  }
}

// Settling takes the rod along.
TEST(RodSensitivities, RestResiduals) {
  Random random(84);
  for (const Learned& learned : EveryLearned()) {
    SCOPED_TRACE(LawName(learned));
    const ModelOptions options = With(learned, 0.4, &random);
    ParameterMap map = EveryParameterMap({});
    map.num_weights = options.learned->num_weights();
    SettlingProblem problem = MakeSettlingProblem({SettlingScene(80.0, 25.0)}, options, map, 3.0);
    problem.first_frame = 40, problem.last_frame = 44;
    const ParameterBlocks blocks = {SharedBlock(map, RecoveringParameters()),
                                    options.learned->weights};
    ExpectCorrectJacobian(SettlingResidual(problem), blocks);
  }
}

}  // namespace
}  // namespace pushid
