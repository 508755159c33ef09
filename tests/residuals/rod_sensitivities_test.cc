// Rollouts with a rod that moves: derivatives by hand against Jets, for every law, with and without
// a self force that sees the rod, in three regimes.
#include "residuals/rod_sensitivities.h"

#include <ceres/dynamic_autodiff_cost_function.h>

#include "residuals/rest_residual.h"
#include "residuals/rollout_residual.h"
#include "tests/residuals/residual_samples.h"

namespace pushid {
namespace {

constexpr int kFrames = 30;

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
          {linear, {NetworkKind::kMlp, 3, 0, true}},
          {mlp, {NetworkKind::kGru, 2, 0, true}},
          {mlp, {NetworkKind::kLstm, 2, 3, true}}};
}

std::string NameOf(const Learned& learned) {
  return "rod " + RodName(learned.rod) + ", self force " + NetworkName(learned.self) +
         (learned.self.rod_input ? " that sees it" : "");
}

ModelOptions With(const Learned& learned, double size, Random* random) {
  return WithNetwork(learned.self, size, random, learned.rod);
}

// Two people, one of whom is not under all forces for a while: the rod moves on.
Scene PushedPair(double lean, double push, Random* random) {
  Scene scene = SceneOfPeople(2, lean, random);
  scene.pushes = {RandomPush(0, 0, 4, PushKind::kNet, push, random),
                  RandomPush(1, 2, 5, PushKind::kNetWithoutFriction, push, random)};
  return scene;
}

PendulumRecording RodPair(const ModelOptions& options, double lean, double push, double noise,
                          Random* random) {
  PendulumRecording recording = RecordRollout(PushedPair(lean, push, random), options,
                                              std::vector(2, RecoveringParameters()), kFrames);
  AddNoise(noise, random, &recording);
  recording.initial_velocity = InitialVelocity::kFree;
  return recording;
}

struct Regime {
  std::string name;
  double lean, push, velocity, noise, weight;
  double absolute;  // tolerance where a whole column vanishes
};

std::ostream& operator<<(std::ostream& out, const Regime& regime) { return out << regime.name; }

class RodTwins : public testing::TestWithParam<Regime> {};

TEST_P(RodTwins, DerivativesByHandEqualJets) {
  const Regime& regime = GetParam();
  Random random(81);
  ParameterMap map = EveryParameterMap({kMu, kAx, kRodLift});
  for (const Learned& learned : EveryLearned()) {
    for (PushUse use : {PushUse::kAdded, PushUse::kAsRecorded}) {
      for (CartDerivative derivative : {CartDerivative::kNone, CartDerivative::kBackward}) {
        SCOPED_TRACE(NameOf(learned));
        ModelOptions options = With(learned, regime.weight, &random);
        options.push = use;
        options.cart_derivative = derivative;
        options.interaction.spring = true;
        map.num_weights = options.self_network->num_weights();
        const PendulumRecording recording =
            RodPair(options, regime.lean, regime.push, regime.noise, &random);
        const auto problem = MakeRolloutProblem(recording, options, map, {}, 0.7, 0);
        ParameterBlocks blocks =
            RandomBlocks(map, problem->layout, RecoveringParameters(), 0.1, 0.0, &random);
        for (double& v : blocks[blocks.size() - 2])
          v = random.Uniform(-regime.velocity, regime.velocity);
        for (double& w : blocks.back()) w = random.Uniform(-regime.weight, regime.weight);
        ceres::DynamicAutoDiffCostFunction<RolloutResidualFunctor, 16> oracle(
            new RolloutResidualFunctor{problem});
        for (int size : problem->layout.BlockSizes()) oracle.AddParameterBlock(size);
        oracle.SetNumResiduals(problem->num_residuals());
        ExpectCorrectJacobian(RolloutResidual(problem), oracle, blocks,
                              {1e-10, regime.absolute, 1e-12});
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
    const PendulumRecording recording = RodPair(options, 0.1, 150.0, 0.0, &random);
    SensitivityInputs inputs;
    inputs.parameters.assign(2, RecoveringParameters());
    inputs.initial_velocity = InitialVelocities(recording.scene);
    inputs.entries.resize(2);
    inputs.num_columns = 8;
    inputs.velocity_column = 0;
    RolloutPath<double> path;
    RolloutSensitivities sensitivities;
    ASSERT_TRUE(
        RolloutWithSensitivities(recording.scene, options, inputs, kFrames, &path, &sensitivities)
            .ok);
    for (int t = 0; t < kFrames; ++t) {
      for (int n = 0; n < 2; ++n) {
        EXPECT_EQ(path.At(t, n).q, recording.states[n][t].q);
        EXPECT_EQ(path.At(t, n).rod, recording.states[n][t].rod);
        EXPECT_EQ(sensitivities.Rod(t, n).size(), 8);
      }
    }
    EXPECT_NE(path.At(kFrames - 1, 0).rod, 0.0) << NameOf(learned);
  }
}

// Weights that a fit does not move are those of the model.
TEST(RodSensitivities, FixedWeightsAreTheModels) {
  Random random(83);
  for (const Learned& learned : EveryLearned()) {
    const ModelOptions options = With(learned, 0.8, &random);
    const PendulumRecording recording = RodPair(options, 0.1, 150.0, 0.0, &random);
    ParameterMap fixed = EveryParameterMap({}), fitted = fixed;
    fitted.num_weights = options.self_network->num_weights();
    const auto evaluate = [&](const ParameterMap& map) {
      const auto problem = MakeRolloutProblem(recording, options, map, {}, 1.0, 0);
      ParameterBlocks blocks = {SharedBlock(map, RecoveringParameters()),
                                std::vector<double>(8, 0.1)};
      if (map.num_weights > 0) blocks.push_back(options.self_network->weights);
      return EvaluateCost(RolloutResidual(problem), blocks, std::vector<bool>(blocks.size(), true));
    };
    const Evaluation with = evaluate(fitted), without = evaluate(fixed);
    EXPECT_EQ(with.residuals, without.residuals);
    EXPECT_TRUE(with.jacobians[0].isApprox(without.jacobians[0], 1e-12));
    EXPECT_TRUE(with.jacobians[1].isApprox(without.jacobians[1], 1e-12));
  }
}

// Settling and stability take the rod along.
TEST(RodSensitivities, RestResiduals) {
  Random random(84);
  for (const Learned& learned : EveryLearned()) {
    SCOPED_TRACE(NameOf(learned));
    const ModelOptions options = With(learned, 0.4, &random);
    ParameterMap map = EveryParameterMap({});
    map.num_weights = options.self_network->num_weights();
    RestProblem problem = SettlingProblem(DemonstrationScene(80.0, 25.0), options, map, {}, 3.0);
    problem.first_frame = 40, problem.last_frame = 44;
    const ParameterBlocks blocks = {SharedBlock(map, RecoveringParameters()),
                                    options.self_network->weights};
    ExpectCorrectJacobian(RestResidual(problem), blocks);
  }
}

}  // namespace
}  // namespace pushid
