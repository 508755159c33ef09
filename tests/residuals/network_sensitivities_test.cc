// Rollouts with a self-force network: derivatives by hand against Jets, for every kind of network,
// in three regimes.
#include "residuals/network_sensitivities.h"

#include <ceres/dynamic_autodiff_cost_function.h>

#include "residuals/rollout_residual.h"
#include "tests/residuals/residual_samples.h"

namespace pushid {
namespace {

constexpr int kFrames = 30;

std::vector<NetworkShape> EveryNetwork() {
  return {{NetworkKind::kMlp, 4},          {NetworkKind::kMlp, 1},
          {NetworkKind::kGru, 3},          {NetworkKind::kGru, 2, 3},
          {NetworkKind::kLstm, 3},         {NetworkKind::kLstm, 2, 4},
          {NetworkKind::kMlp, 3, 0, true}, {NetworkKind::kGru, 2, 0, true}};
}

// Two people, one of whom is not under all forces for a while: a network thinks on.
PendulumRecording NetworkPair(const ModelOptions& options, double lean, double push, double noise,
                              Random* random) {
  Scene scene = SceneOfPeople(2, lean, random);
  scene.pushes = {RandomPush(0, 0, 4, PushKind::kNet, push, random),
                  RandomPush(1, 2, 5, PushKind::kNetWithoutFriction, push, random)};
  PendulumRecording recording =
      RecordRollout(scene, options, std::vector(2, RecoveringParameters()), kFrames);
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

class NetworkTwins : public testing::TestWithParam<Regime> {};

TEST_P(NetworkTwins, DerivativesByHandEqualJets) {
  const Regime& regime = GetParam();
  Random random(51);
  ParameterMap map = EveryParameterMap({kMu, kAx});
  for (const NetworkShape& shape : EveryNetwork()) {
    for (PushUse use : {PushUse::kAdded, PushUse::kAsRecorded}) {
      SCOPED_TRACE(NetworkName(shape));
      ModelOptions options = WithNetwork(shape, regime.weight, &random);
      options.push = use;
      map.num_weights = shape.num_weights();
      const PendulumRecording recording =
          NetworkPair(options, regime.lean, regime.push, regime.noise, &random);
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

INSTANTIATE_TEST_SUITE_P(ThreeRegimes, NetworkTwins,
                         testing::Values(Regime{"at_rest", 0.0, 0.0, 0.0, 0.0, 0.5, 1e-14},
                                         // Jets lose to cancellation there.
                                         Regime{"tiny", 0.0, 1e-6, 1e-8, 1e-8, 0.5, 1e-15},
                                         Regime{"large", 0.1, 150.0, 0.3, 0.05, 1.5, 1e-13}),
                         [](const auto& test) { return test.param.name; });

// Whatever the weights, nobody who stands still is moved.
TEST(SelfNetwork, IsSilentAtRest) {
  Random random(52);
  for (const NetworkShape& shape : EveryNetwork()) {
    const ModelOptions options = WithNetwork(shape, 3.0, &random);
    NetworkState<double> state(shape, {60.0, 0.9, 0.0});
    for (int t = 0; t < 20; ++t) {
      EXPECT_EQ(StepNetwork(shape, options.self_network->weights.data(), 60.0, &state).norm(), 0.0)
          << NetworkName(shape);
    }
  }
}

// A network that a fit does not move has the weights of its model.
TEST(SelfNetwork, FixedWeightsAreTheModels) {
  Random random(53);
  for (const NetworkShape& shape : EveryNetwork()) {
    const ModelOptions options = WithNetwork(shape, 1.0, &random);
    const PendulumRecording recording = NetworkPair(options, 0.1, 150.0, 0.0, &random);
    ParameterMap fixed = EveryParameterMap({}), fitted = fixed;
    fitted.num_weights = shape.num_weights();
    const auto evaluate = [&](const ParameterMap& map) {
      const auto problem = MakeRolloutProblem(recording, options, map, {}, 1.0, 0);
      Random again(54);
      ParameterBlocks blocks =
          RandomBlocks(map, problem->layout, RecoveringParameters(), 0.0, 0.1, &again);
      blocks[1] = std::vector<double>(8, 0.1);
      if (map.num_weights > 0) blocks.back() = options.self_network->weights;
      return EvaluateCost(RolloutResidual(problem), blocks, std::vector<bool>(blocks.size(), true));
    };
    const Evaluation with = evaluate(fitted), without = evaluate(fixed);
    EXPECT_EQ(with.residuals, without.residuals);
    // Products of other sizes round otherwise.
    EXPECT_TRUE(with.jacobians[0].isApprox(without.jacobians[0], 1e-12));
    EXPECT_TRUE(with.jacobians[1].isApprox(without.jacobians[1], 1e-12));
  }
}

TEST(SelfNetwork, SizesAndNames) {
  const NetworkShape mlp{NetworkKind::kMlp, 4}, gru{NetworkKind::kGru, 8},
      lstm{NetworkKind::kLstm, 256, 32};
  EXPECT_EQ(mlp.num_weights(), 4 * (6 + 2) + 4 * 4);
  EXPECT_EQ(gru.num_weights(), 16 * (6 + 8 + 2) + 8 * (6 + 8) + 4 * 8);
  EXPECT_EQ(lstm.num_weights(), 32 * 6 + 768 * (32 + 256 + 2) + 256 * (32 + 256) + 4 * 256);
  EXPECT_EQ(NetworkName(mlp), "mlp:4");
  EXPECT_EQ(NetworkName(gru), "gru:8");
  EXPECT_EQ(NetworkName(lstm), "lstm:256:32");
  EXPECT_EQ(NetworkName({}), "none");
}

}  // namespace
}  // namespace pushid
