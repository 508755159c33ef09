// Rollouts of models that learn - self forces, laws of the rod, what people do to each other:
// derivatives against differences for every kind of network, in three regimes.
#include "residuals/cost_functions/rest_residual.h"
#include "tests/residuals/learned_pair.h"

namespace pushid {
namespace {

std::vector<NetworkShape> EveryNetwork() {
  return {{NetworkKind::kMlp, 4}, {NetworkKind::kMlp, 1}, {NetworkKind::kLdp, 3, 4}};
}

class NetworkTwins : public testing::TestWithParam<Regime> {};

TEST_P(NetworkTwins, DerivativesEqualDifferences) {
  const Regime& regime = GetParam();
  Random random(51);
  const ParameterMap map = EveryParameterMap({kMu, kAx});
  for (const NetworkShape& shape : EveryNetwork()) {
    for (PushUse use : {PushUse::kAdded, PushUse::kAsRecorded}) {
      SCOPED_TRACE(NetworkName(shape));
      ModelOptions options = WithNetwork(shape, regime.weight, &random);
      options.push = use;
      ExpectDerivativesEqualDifferences(options, map, regime, &random);
      if (HasFailure()) return;
    }
  }
}

// Two people who touch, and a network that says what they do to each other.
TEST_P(NetworkTwins, OfPairsEqualDifferences) {
  Regime regime = GetParam();
  regime.weight *= 0.3;  // contact alone is hard enough to stay upright in
  Random random(72);
  for (const PairShape& shape : {PairShape{{3, 2}}, PairShape{{4}, true}}) {
    SCOPED_TRACE(PairName(shape));
    ModelOptions options = WithNetwork({}, regime.weight, &random, {}, shape);
    options.interaction.spring = options.interaction.damping = true;
    ExpectDerivativesEqualDifferences(options, EveryParameterMap({kMu}), regime, &random);
    ExpectFixedWeightsAreTheModels(options, &random);
  }
}

INSTANTIATE_TEST_SUITE_P(ThreeRegimes, NetworkTwins,
                         testing::Values(Regime{"at_rest", 0.0, 0.0, 0.0, 0.0, 0.5, 1e-11},
                                         Regime{"tiny", 0.0, 1e-6, 1e-8, 1e-8, 0.5, 1e-12},
                                         Regime{"large", 0.1, 150.0, 0.3, 0.05, 1.5, 1e-10}),
                         [](const auto& test) { return test.param.name; });

// Whatever the weights, a person who stands still is not moved; LDP's network alone may do that.
TEST(LearnedTerms, IsSilentAtRest) {
  Random random(52);
  for (const NetworkShape& shape : EveryNetwork()) {
    if (shape.ldp()) continue;
    const ModelOptions options = WithNetwork(shape, 3.0, &random);
    const double* const weights = options.learned->weights.data();
    NetworkState<double> state(shape, weights, {60.0, 0.9, 0.0});
    for (int t = 0; t < 20; ++t) {
      EXPECT_EQ(StepNetwork(shape, weights, &state).norm(), 0.0) << NetworkName(shape);
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
    NetworkState<double> state(shape, w.data(), {mass, 0.9, 0.0});
    Vector4<double> last;
    for (int t = 0; t < steps; ++t) {
      SetMotionInputs<double>(0.0, 0.0, {0.0, 0.0, rate, 0.0}, &state.inputs);
      last = StepNetwork(shape, w.data(), &state);
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
  const NetworkShape mlp{NetworkKind::kMlp, 4}, ldp{NetworkKind::kLdp, 256, 32};
  EXPECT_EQ(mlp.num_weights(), 4 * (6 + 2) + 4 * 4);
  EXPECT_EQ(ldp.num_weights(), 298244) << "of the paper";
  EXPECT_EQ(NetworkName(ldp), "ldp:256:32");
  EXPECT_EQ(NetworkName(mlp), "mlp:4");
  EXPECT_EQ(NetworkName({}), "none");
}

struct Learned {
  RodShape rod;
  NetworkShape self;
};

std::vector<Learned> EveryLearned() {
  const RodShape rod{RodKind::kLdp, {3}}, deep{RodKind::kLdp, {3, 2}};
  return {{rod, {}}, {deep, {}}, {rod, {NetworkKind::kMlp, 2}}, {rod, {NetworkKind::kLdp, 2, 3}}};
}

std::string LawName(const Learned& learned) {
  return "rod " + RodName(learned.rod) + ", self force " + NetworkName(learned.self);
}

ModelOptions With(const Learned& learned, double size, Random* random) {
  return WithNetwork(learned.self, size, random, learned.rod);
}

class RodTwins : public testing::TestWithParam<Regime> {};

TEST_P(RodTwins, DerivativesEqualDifferences) {
  const Regime& regime = GetParam();
  Random random(81);
  const ParameterMap map = EveryParameterMap({kMu, kAx});
  for (const Learned& learned : EveryLearned()) {
    for (PushUse use : {PushUse::kAdded, PushUse::kAsRecorded}) {
      for (CartDerivative derivative : {CartDerivative::kNone, CartDerivative::kBackward}) {
        SCOPED_TRACE(LawName(learned));
        ModelOptions options = With(learned, regime.weight, &random);
        options.push = use;
        options.cart_derivative = derivative;
        options.interaction.spring = true;
        ExpectDerivativesEqualDifferences(options, map, regime, &random);
        if (HasFailure()) return;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(ThreeRegimes, RodTwins,
                         testing::Values(Regime{"at_rest", 0.0, 0.0, 0.0, 0.0, 0.5, 1e-11},
                                         Regime{"tiny", 0.0, 1e-6, 1e-8, 1e-8, 0.5, 1e-12},
                                         Regime{"large", 0.1, 150.0, 0.3, 0.05, 1.0, 1e-10}),
                         [](const auto& test) { return test.param.name; });

TEST(LearnedRod, FixedWeightsAreTheModels) {
  Random random(83);
  for (const Learned& learned : EveryLearned()) {
    ExpectFixedWeightsAreTheModels(With(learned, 0.8, &random), &random);
  }
}

// Settling takes the rod along.
TEST(LearnedRod, RestResiduals) {
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
