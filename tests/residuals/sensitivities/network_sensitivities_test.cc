// Rollouts with a self-force network: derivatives by hand against Jets, for every kind of network,
// in three regimes.
#include "residuals/sensitivities/network_sensitivities.h"

#include "tests/residuals/learned_pair.h"

namespace pushid {
namespace {

std::vector<NetworkShape> EveryNetwork() {
  return {{NetworkKind::kMlp, 4},    {NetworkKind::kMlp, 1},  {NetworkKind::kGru, 3},
          {NetworkKind::kGru, 2, 3}, {NetworkKind::kLstm, 3}, {NetworkKind::kLstm, 2, 4},
          {NetworkKind::kLdp, 3, 4}};
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

// Whatever the weights, a person who stands still is not moved; LDP's network alone may do that.
TEST(LearnedTerms, IsSilentAtRest) {
  Random random(52);
  for (const NetworkShape& shape : EveryNetwork()) {
    if (shape.biased()) continue;
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

// One unit behind an embedding of one: x = max(0, thd / 0.6 + (M - 85) / 20 + 1), all gates open by
// their two biases, g = tanh(0.5 x), F_x = 170 N (h + 0.25).
TEST(LearnedTerms, LdpsByHand) {
  const NetworkShape shape{NetworkKind::kLdp, 1, 1};
  std::vector<double> w(shape.num_weights(), 0.0);
  ASSERT_EQ(w.size(), 8u + 4u * 4u + 8u);
  w[4] = 1.0, w[6] = 1.0, w[7] = 1.0;  // of thd, mass, 1
  for (int gate : {0, 1, 2}) w[8 + 4 * gate + 2] = w[8 + 4 * gate + 3] = 50.0;
  w[8 + 4 * 3] = 0.5;
  w[24] = 1.0, w[25] = 0.25;
  const auto force = [&](double mass, double rate, int steps) {
    NetworkState<double> state(shape, {mass, 0.9, 0.0});
    Vector4<double> last;
    for (int t = 0; t < steps; ++t) {
      SetNetworkInputs<double>(0.0, 0.0, {0.0, 0.0, rate, 0.0}, &state);
      last = StepNetwork(shape, w.data(), mass, &state);
    }
    return last;
  };
  const double x = 0.3 + 0.5 + 1.0, g = std::tanh(0.5 * x);
  EXPECT_NEAR(force(95.0, 0.18, 1)[0], 170.0 * (std::tanh(g) + 0.25), 1e-10);
  EXPECT_NEAR(force(95.0, 0.18, 2)[0], 170.0 * (std::tanh(2.0 * g) + 0.25), 1e-10) << "it adds up";
  EXPECT_NEAR(force(85.0, -0.9, 1)[0], 170.0 * 0.25, 1e-10) << "rectified";
  EXPECT_EQ(force(95.0, 0.18, 2).tail<3>().norm(), 0.0);
}

TEST(LearnedTerms, SizesAndNames) {
  const NetworkShape mlp{NetworkKind::kMlp, 4}, gru{NetworkKind::kGru, 8},
      lstm{NetworkKind::kLstm, 256, 32}, ldp{NetworkKind::kLdp, 256, 32};
  EXPECT_EQ(mlp.num_weights(), 4 * (6 + 2) + 4 * 4);
  EXPECT_EQ(gru.num_weights(), 16 * (6 + 8 + 2) + 8 * (6 + 8) + 4 * 8);
  EXPECT_EQ(lstm.num_weights(), 32 * 6 + 768 * (32 + 256 + 2) + 256 * (32 + 256) + 4 * 256);
  EXPECT_EQ(ldp.num_weights(), 298244) << "of the paper";
  EXPECT_EQ(NetworkName(ldp), "ldp:256:32");
  EXPECT_EQ(NetworkName(mlp), "mlp:4");
  EXPECT_EQ(NetworkName(gru), "gru:8");
  EXPECT_EQ(NetworkName(lstm), "lstm:256:32");
  EXPECT_EQ(NetworkName({}), "none");
}

}  // namespace
}  // namespace pushid
