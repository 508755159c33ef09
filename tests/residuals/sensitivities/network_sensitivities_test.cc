// Rollouts with a self-force network: derivatives by hand against Jets, for every kind of network,
// in three regimes.
#include "residuals/sensitivities/network_sensitivities.h"

#include "tests/residuals/learned_pair.h"

namespace pushid {
namespace {

std::vector<NetworkShape> EveryNetwork() {
  return {{NetworkKind::kMlp, 4},    {NetworkKind::kMlp, 1},  {NetworkKind::kGru, 3},
          {NetworkKind::kGru, 2, 3}, {NetworkKind::kLstm, 3}, {NetworkKind::kLstm, 2, 4}};
}

class NetworkTwins : public testing::TestWithParam<Regime> {};

TEST_P(NetworkTwins, DerivativesByHandEqualJets) {
  const Regime& regime = GetParam();
  Random random(51);
  const ParameterMap map = EveryParameterMap({kMu, kAx});
  for (const NetworkShape& shape : EveryNetwork()) {
    for (PushUse use : {PushUse::kAdded, PushUse::kAsRecorded}) {
      SCOPED_TRACE(NetworkName(shape));
      ModelOptions options = WithNetwork(shape, regime.weight, &random);
      options.push = use;
      ExpectDerivativesEqualJets(options, map, regime, &random);
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

// Whatever the weights, a person who stands still is not moved.
TEST(LearnedTerms, IsSilentAtRest) {
  Random random(52);
  for (const NetworkShape& shape : EveryNetwork()) {
    const ModelOptions options = WithNetwork(shape, 3.0, &random);
    NetworkState<double> state(shape, {60.0, 0.9, 0.0});
    for (int t = 0; t < 20; ++t) {
      EXPECT_EQ(StepNetwork(shape, options.learned->weights.data(), 60.0, &state).norm(), 0.0)
          << NetworkName(shape);
    }
  }
}

// A network that a fit does not move has the weights of its model.
TEST(LearnedTerms, FixedWeightsAreTheModels) {
  Random random(53);
  for (const NetworkShape& shape : EveryNetwork()) {
    ExpectFixedWeightsAreTheModels(WithNetwork(shape, 1.0, &random), &random);
  }
}

TEST(LearnedTerms, SizesAndNames) {
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
