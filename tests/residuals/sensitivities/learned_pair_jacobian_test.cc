// Derivatives of a learned interaction against Jets: of the force itself, and of whole rollouts, in
// three regimes.
#include "residuals/sensitivities/learned_pair_jacobian.h"

#include <ceres/jet.h>

#include "tests/residuals/learned_pair.h"

namespace pushid {
namespace {

constexpr int kWeights = 11 * 3 + 4 * 2 + 3 * 4;
constexpr int kLearnedColumns = kPairStates + kNumPairParameters + kWeights;
using LearnedJet = ceres::Jet<double, kLearnedColumns>;

struct Motion {
  std::string name;
  double load, lean, speed, weight;
};

std::ostream& operator<<(std::ostream& out, const Motion& motion) { return out << motion.name; }

class LearnedPairForce : public testing::TestWithParam<Motion> {};

TEST_P(LearnedPairForce, DerivativesByHandEqualJets) {
  const Motion& motion = GetParam();
  Random random(71);
  const PairShape shape{{3, 2}};
  ASSERT_EQ(shape.num_weights(), kWeights);
  int loaded = 0;
  for (int trial = 0; trial < 20; ++trial) {
    const Scene scene = SceneOfPeople(2, 0.05, &random);
    const Pair pair = PairOf(scene, 0, 1);
    const ParameterSet<double> p = RandomRecoveringParameters(&random, 0.2);
    PendulumState<double> n = scene.people[0].start, j = scene.people[1].start;
    for (PendulumState<double>* state : {&n, &j}) {
      for (int i = 0; i < 4; ++i) state->qd[i] = random.Uniform(-motion.speed, motion.speed);
      for (int i : {2, 3}) state->q[i] = random.Uniform(-motion.lean, motion.lean);
    }
    j.q[1] = n.q[1] + 0.01;
    j.q[0] = n.q[0] + std::min(p[kContactDistance], 0.62) - motion.load;
    std::vector<double> weights(kWeights);
    std::vector<LearnedJet> jet_weights(kWeights);
    for (int i = 0; i < kWeights; ++i) {
      weights[i] = random.Uniform(-motion.weight, motion.weight);
      jet_weights[i] = LearnedJet(weights[i], kPairStates + kNumPairParameters + i);
    }
    ParameterSet<LearnedJet> parameters;
    for (int i = 0; i < kNumParameters; ++i) {
      const int column = i - kFirstPairParameter;
      const bool shared = column >= 0 && column < kNumPairParameters;
      parameters[i] = shared ? LearnedJet(p[i], kPairStates + column) : LearnedJet(p[i]);
    }
    PairForce<LearnedJet> force;
    AddLearnedPair(shape, jet_weights.data(), pair, parameters, JetState<LearnedJet>(n, 0),
                   JetState<LearnedJet>(j, 8), &force);
    if (!force.acts) continue;  // their leans part them
    ++loaded;
    PairJacobian jacobian{};
    jacobian.by_states.setZero();
    jacobian.by_parameter.setZero();
    PairByWeight by_weight;
    AddLearnedPairJacobian(shape, weights.data(), pair, p, n, j, &jacobian, &by_weight);
    for (int row = 0; row < 8; ++row) {
      const LearnedJet& expected = row < 4 ? force.on_n[row] : force.on_j[row - 4];
      Eigen::Matrix<double, 1, kLearnedColumns> actual;
      actual << jacobian.by_states.row(row), jacobian.by_parameter.row(row), by_weight.row(row);
      const double scale = std::max(1.0, expected.v.cwiseAbs().maxCoeff());
      EXPECT_LT((actual - expected.v.transpose()).cwiseAbs().maxCoeff(), 1e-11 * scale) << row;
    }
  }
  EXPECT_GT(loaded, 5);
}

INSTANTIATE_TEST_SUITE_P(Regimes, LearnedPairForce,
                         testing::Values(Motion{"just_touching", 0.03, 1e-3, 1e-3, 0.5},
                                         Motion{"in_motion", 0.1, 0.1, 0.5, 1.0},
                                         Motion{"far_from_rest", 0.2, 0.6, 3.0, 2.0}),
                         [](const auto& test) { return test.param.name; });

// Alone, beside contact, and with everything else that is learned.
std::vector<ModelOptions> SomeModels(double weight, Random* random) {
  std::vector<ModelOptions> models = {
      WithNetwork({}, weight, random, {}, {{4}}), WithNetwork({}, weight, random, {}, {{3, 2}}),
      WithNetwork({NetworkKind::kGru, 2}, weight, random, {RodKind::kLinear, {}}, {{2}})};
  for (ModelOptions& options : models) {
    options.interaction.damping = true;
  }
  models[0].interaction = {};
  models[0].interaction.learned = true;
  models[1].interaction.spring = true;
  models.push_back(WithNetwork({}, weight, random, {}, {{3, 2}, true}));
  models.back().interaction.ldp_published = true;
  return models;
}

class LearnedPairRollouts : public testing::TestWithParam<Regime> {};

TEST_P(LearnedPairRollouts, DerivativesByHandEqualJets) {
  const Regime& regime = GetParam();
  Random random(72);
  for (const ModelOptions& options : SomeModels(regime.weight, &random)) {
    SCOPED_TRACE(options.learned->pair.hidden.size());
    ExpectDerivativesEqualJets(options, EveryParameterMap({kMu, kContactDistance}), regime,
                               &random);
    if (HasFailure()) return;
  }
}

INSTANTIATE_TEST_SUITE_P(ThreeRegimes, LearnedPairRollouts,
                         testing::Values(Regime{"at_rest", 0.0, 0.0, 0.0, 0.0, 0.5, 1e-14},
                                         Regime{"moderate", 0.02, 60.0, 0.1, 0.01, 0.3, 1e-13},
                                         Regime{"large", 0.1, 150.0, 0.3, 0.05, 0.6, 1e-13}),
                         [](const auto& test) { return test.param.name; });

TEST(LearnedPairRollouts, FixedWeightsAreTheModels) {
  Random random(73);
  for (const ModelOptions& options : SomeModels(0.5, &random)) {
    ExpectFixedWeightsAreTheModels(options, &random);
  }
}

// All pairs of a frame at once, some of whom do not touch, and pair by pair.
class HeldPairsOf : public testing::TestWithParam<bool> {};  // LDP's network

TEST_P(HeldPairsOf, AreThoseOfEachPairAlone) {
  Random random(74);
  ModelOptions options = WithNetwork({}, 0.3, &random, {}, {{20, 9}, GetParam()});
  options.interaction.spring = options.interaction.damping = true;
  const PairShape& shape = options.learned->pair;
  const double* const weights = options.learned->weights.data();
  Scene scene = SceneOfPeople(6, 0.05, &random);
  for (int n = 4; n < 6; ++n) scene.people[n].start.q[0] += 5.0;
  std::vector<ParameterSet<double>> p(6, RecoveringParameters());
  p[0][kNeighbourRange] = 3.0;
  SceneForces<double> forces(scene, options, p);
  HeldPairs held(shape, weights);
  int touching = 0;
  for (double apart : {-0.2, -0.3, 20.0, -0.25}) {  // closer than at first, or nobody near anybody
    std::vector<PendulumState<double>> states;
    for (int n = 0; n < 6; ++n) {
      states.push_back({scene.people[n].start.q, Vector4<double>::Zero()});
      states.back().q[0] += apart * n;
      for (int i = 0; i < 4; ++i) states.back().qd[i] = random.Uniform(-0.5, 0.5);
    }
    forces.Update(states.data());
    forces.PrepareAll();
    held.Ask(forces);
    for (size_t k = 0; k < forces.acting().size(); ++k, ++touching) {
      const auto& [n, j] = forces.acting()[k];
      PairJacobian alone;
      alone.by_states.setZero();
      alone.by_parameter.setZero();
      PairJacobian together = alone;
      AddLearnedPairJacobian(shape, weights, forces.pairs().Of(n, j), p[0], forces.state(n),
                             forces.state(j), &alone, nullptr);
      held.AddTo(k, forces, &together);
      const double scale = alone.by_states.cwiseAbs().maxCoeff();
      EXPECT_GT(scale, 0.0);
      EXPECT_LT((alone.by_states - together.by_states).cwiseAbs().maxCoeff(), 1e-12 * scale);
      EXPECT_LT((alone.by_parameter - together.by_parameter).cwiseAbs().maxCoeff(),
                1e-12 * std::max(1.0, alone.by_parameter.cwiseAbs().maxCoeff()));
    }
  }
  EXPECT_GT(touching, 8);
}

INSTANTIATE_TEST_SUITE_P(Both, HeldPairsOf, testing::Values(false, true));

}  // namespace
}  // namespace pushid
