// Derivatives of what two people do to each other against Jets, called directly, in three regimes:
// where contact has just begun, in ordinary motion, and far from rest.
#include <ceres/jet.h>

#include "residuals/sensitivities/net_force_jacobian.h"
#include "tests/residuals/residual_samples.h"

namespace pushid {
namespace {

constexpr int kPairColumns = kPairStates + kNumPairParameters;
using PairJet = ceres::Jet<double, kPairColumns>;

struct PairMotion {
  std::string name;
  double load;   // m of compression along x, about
  double lean;   // rad
  double speed;  // m/s and rad/s
};

std::ostream& operator<<(std::ostream& out, const PairMotion& regime) { return out << regime.name; }

PairForce<PairJet> ForceOfJets(const InteractionTerms& terms, const Pair& pair,
                               const ParameterSet<double>& p, const PendulumState<double>& n,
                               const PendulumState<double>& j) {
  ParameterSet<PairJet> parameters;
  for (int i = 0; i < kNumParameters; ++i) {
    const int column = i - kFirstPairParameter;
    const bool shared = column >= 0 && column < kNumPairParameters;
    parameters[i] = shared ? PairJet(p[i], kPairStates + column) : PairJet(p[i]);
  }
  return InteractionBetween(terms, pair, parameters, JetState<PairJet>(n, 0),
                            JetState<PairJet>(j, 8));
}

void ExpectEqualJets(const InteractionTerms& terms, const Pair& pair, const ParameterSet<double>& p,
                     const PendulumState<double>& n, const PendulumState<double>& j, bool* acts) {
  const PairForce<PairJet> force = ForceOfJets(terms, pair, p, n, j);
  const PairJacobian jacobian = ComputePairJacobian(terms, pair, p, n, j);
  for (int row = 0; row < 8; ++row) {
    const PairJet& expected = row < 4 ? force.on_n[row] : force.on_j[row - 4];
    const double scale = std::max(1.0, expected.v.cwiseAbs().maxCoeff());
    for (int column = 0; column < kPairColumns; ++column) {
      const double value = column < kPairStates ? jacobian.by_states(row, column)
                                                : jacobian.by_parameter(row, column - kPairStates);
      EXPECT_NEAR(value, expected.v[column], 1e-11 * scale)
          << DescribeTerms(terms) << ", row " << row << ", column " << column;
    }
  }
  *acts = *acts || force.acts;
}

class PairJacobians : public testing::TestWithParam<PairMotion> {};

TEST_P(PairJacobians, EqualJetsForEveryTerm) {
  const PairMotion& regime = GetParam();
  Random random(5);
  for (const InteractionTerms& terms : SomeInteractions()) {
    bool acts = false;
    for (int trial = 0; trial < 20; ++trial) {
      const Scene scene = SceneOfPeople(2, 0.05, &random);
      const Pair pair = PairOf(scene, 0, 1);
      const ParameterSet<double> p = RandomRecoveringParameters(&random, 0.2);
      // Behind the other one by the contact distance less the load, at the height of contact alike.
      PendulumState<double> n = scene.people[0].start, j = scene.people[1].start;
      for (PendulumState<double>* state : {&n, &j}) {
        for (int i = 0; i < 4; ++i) {
          state->qd[i] = random.Uniform(-regime.speed, regime.speed);
        }
        for (int i : {2, 3}) state->q[i] = random.Uniform(-regime.lean, regime.lean);
      }
      j.q[1] = n.q[1] + 0.01;
      // 0.62 m: a little nearer than they stood, which would be free of load.
      j.q[0] = n.q[0] + std::min(p[kContactDistance], 0.62) - regime.load;
      ExpectEqualJets(terms, pair, p, n, j, &acts);
    }
    EXPECT_EQ(acts, terms.Any()) << DescribeTerms(terms);
  }
}

INSTANTIATE_TEST_SUITE_P(Regimes, PairJacobians,
                         testing::Values(PairMotion{"just_touching", 0.03, 1e-3, 1e-3},
                                         PairMotion{"in_motion", 0.1, 0.1, 0.5},
                                         PairMotion{"far_from_rest", 0.2, 0.6, 3.0}),
                         [](const auto& regime) { return regime.param.name; });

}  // namespace
}  // namespace pushid
