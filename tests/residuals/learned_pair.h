// tests: two pushed people of a model that learns, and derivatives in regimes.
#pragma once

#include <ostream>
#include <string>

#include "residuals/jets/autodiff_rollout.h"
#include "tests/residuals/residual_samples.h"

namespace pushid {

inline constexpr int kPairFrames = 30;

struct Regime {
  std::string name;
  double lean, push, velocity, noise, weight;
  double absolute;  // tolerance where a whole column vanishes
};

inline std::ostream& operator<<(std::ostream& out, const Regime& regime) {
  return out << regime.name;
}

// Two people, one of whom is not under all forces for a while: what is learned goes on.
inline PendulumRecording LearnedPair(const ModelOptions& options, double lean, double push,
                                     double noise, Random* random) {
  Scene scene = SceneOfPeople(2, lean, random);
  scene.pushes = {RandomPush(0, 0, 4, PushKind::kNet, push, random),
                  RandomPush(1, 2, 5, PushKind::kNetWithoutFriction, push, random)};
  PendulumRecording recording =
      RecordRollout(scene, options, std::vector(2, RecoveringParameters()), kPairFrames);
  AddNoise(noise, random, &recording);
  recording.initial_velocity = InitialVelocity::kFree;
  return recording;
}

// Weights and parameters at random, those of map fitted.
inline void ExpectDerivativesEqualDifferences(const ModelOptions& options, ParameterMap map,
                                              const Regime& regime, Random* random) {
  map.num_weights = options.learned->num_weights();
  const PendulumRecording recording =
      LearnedPair(options, regime.lean, regime.push, regime.noise, random);
  const auto problem = MakeRolloutProblem(recording, options, map, {}, 0.7, 0);
  ParameterBlocks blocks =
      RandomBlocks(map, problem->layout, RecoveringParameters(), 0.1, 0.0, random);
  for (double& v : blocks[blocks.size() - 2])
    v = random->Uniform(-regime.velocity, regime.velocity);
  for (double& w : blocks.back()) w = random->Uniform(-regime.weight, regime.weight);
  ExpectDirectionalDerivatives(AutoDiffRollout(problem), blocks, {1e-6, regime.absolute, 0.0});
}

// Residuals and derivatives by everything else are the same, whether or not weights are fitted.
inline void ExpectFixedWeightsAreTheModels(const ModelOptions& options, Random* random) {
  const PendulumRecording recording = LearnedPair(options, 0.1, 150.0, 0.0, random);
  ParameterMap fixed = EveryParameterMap({}), fitted = fixed;
  fitted.num_weights = options.learned->num_weights();
  const auto evaluate = [&](const ParameterMap& map) {
    const auto problem = MakeRolloutProblem(recording, options, map, {}, 1.0, 0);
    ParameterBlocks blocks = {SharedBlock(map, RecoveringParameters()),
                              std::vector<double>(8, 0.1)};
    if (map.num_weights > 0) blocks.push_back(options.learned->weights);
    return EvaluateCost(AutoDiffRollout(problem), blocks, std::vector<bool>(blocks.size(), true));
  };
  const CostEvaluation with = evaluate(fitted), without = evaluate(fixed);
  EXPECT_EQ(with.residuals, without.residuals);
  // Products of other sizes round otherwise.
  EXPECT_TRUE(with.jacobians[0].isApprox(without.jacobians[0], 1e-12));
  EXPECT_TRUE(with.jacobians[1].isApprox(without.jacobians[1], 1e-12));
}

}  // namespace pushid
