// The derivatives that are written out for lanes against automatic ones.
#include "residuals/force_jacobians.h"

#include <ceres/jet.h>

#include "models/self_force.h"
#include "tests/models/model_samples.h"

namespace pushid {
namespace {

// By [q, qd] and by the parameters, in that order.
constexpr int kParameters = 8, kVariables = kParameters + kNumParameters;
using Jet = ceres::Jet<double, kVariables>;
using AllDerivatives = Eigen::Matrix<double, 4, kVariables>;

AllDerivatives Derivatives(const Vector4<Jet>& of) {
  AllDerivatives derivatives;
  for (int i = 0; i < 4; ++i) derivatives.row(i) = of[i].v.transpose();
  return derivatives;
}

AllDerivatives Flat(const SelfJacobian<double>& jacobian) {
  AllDerivatives flat = AllDerivatives::Zero();
  flat.leftCols<8>() = jacobian.by_state;
  flat.rightCols<kNumParameters>() = jacobian.by_parameter;
  return flat;
}

// magnitude: 0 at rest, 1e-8 close to it, 1 large motions.
void ExpectCorrectSelfJacobian(const ModelOptions& options, double magnitude, Random* random) {
  const Vector4<double> q0 = 0.1 * RandomState(random).q;
  const SelfForce self(options, RandomBody(random), q0, kSampleDt);
  const ParameterSet<double> values = RandomParameters(random);
  PendulumState<double> at = RandomState(random, magnitude);
  if (magnitude < 1.0) at.q += q0;  // rest is the initial posture
  ParameterSet<Jet> p;
  PendulumState<Jet> state;
  for (int i = 0; i < 4; ++i) {
    state.q[i] = Jet(at.q[i], i);
    state.qd[i] = Jet(at.qd[i], 4 + i);
  }
  for (int i = 0; i < kNumParameters; ++i) p[i] = Jet(values[i], kParameters + i);

  SelfJacobian<double> jacobian;
  // Entries that are always written must keep no NaN.
  jacobian.by_parameter.middleCols<kKpX - kMu>(kMu).topRows<2>().setConstant(NAN);
  AddFrictionJacobian(self, values, at.qd, &jacobian);
  ExpectClose(Flat(jacobian), Derivatives(self.Friction(p, state.qd)), 1e-12);
  AddControlJacobian(self, values, at, &jacobian);
  ExpectClose(Flat(jacobian), Derivatives(OwnForce(self, p, state, state.qd)), 1e-12);
}

class SelfForceJacobian : public testing::TestWithParam<double> {};

TEST_P(SelfForceJacobian, EqualsAutomaticDerivatives) {
  Random random(1);
  for (Posture posture : {Posture::kUpright, Posture::kInitial}) {
    for (GainScaling scaling : {GainScaling::kNone, GainScaling::kMass, GainScaling::kBody}) {
      for (const auto& friction : Names(FrictionKind{})) {
        ModelOptions options;
        options.posture = posture;
        options.gain_scaling = scaling;
        options.friction = friction.value;
        ExpectCorrectSelfJacobian(options, GetParam(), &random);
      }
    }
  }
}
INSTANTIATE_TEST_SUITE_P(ThreeRegimes, SelfForceJacobian, testing::Values(0.0, 1e-8, 1.0),
                         [](const auto& test) {
                           return test.param == 0.0   ? "at_rest"
                                  : test.param == 1.0 ? "large"
                                                      : "close_to_rest";
                         });

TEST(TailJacobian, EqualsAutomaticDerivatives) {
  using TailJacobian = Eigen::Matrix<double, 4, kNumParameters>;
  using ParameterJet = ceres::Jet<double, kNumParameters>;
  constexpr double kMass = 80.0;
  Random random(3);
  for (int trial = 0; trial < 50; ++trial) {
    // Beyond the longest duration that the tail's time grows with.
    std::vector<Vector4<double>> rows(1 + trial % 30);
    for (Vector4<double>& row : rows) row = RandomVector(&random, 400.0);
    const ScenePush push = MakeScenePush(0, 3, PushKind::kNet, rows);
    ParameterSet<double> p = RandomParameters(&random);
    p[kTailTime] = random.Uniform(0.05, 0.5);
    ParameterSet<ParameterJet> jets;
    for (int i = 0; i < kNumParameters; ++i) jets[i] = ParameterJet(p[i], i);
    for (int frame : {push.EndFrame(), push.EndFrame() + 17}) {
      const Vector4<ParameterJet> force = TailForce(push, kMass, jets, frame, kSampleDt);
      TailJacobian expected;
      for (int i = 0; i < 4; ++i) expected.row(i) = force[i].v.transpose();
      // The Jacobian is added to what is there.
      TailJacobian jacobian = TailJacobian::Constant(7.0);
      const TailOf<double> tail = TailAt(push, kMass, frame, kSampleDt);
      const double rate = tail.Rate(p);
      AddTailJacobian(tail, p, rate, tail.Decay(rate), &jacobian);
      ExpectClose((jacobian - TailJacobian::Constant(7.0)).eval(), expected, 1e-12, 7.0);
    }
  }
}

TEST(InverseDynamicsJacobian, EqualsAutomaticDerivatives) {
  using StateJet = ceres::Jet<double, 4>;
  Random random(5);
  for (int trial = 0; trial < 20; ++trial) {
    const Body body = RandomBody(&random);
    const PendulumState<double> at = RandomState(&random);
    const Vector4<double> a = RandomVector(&random, 5.0);
    PendulumState<StateJet> state;
    for (int i = 0; i < 4; ++i) {
      state.q[i] = i < 2 ? StateJet(at.q[i]) : StateJet(at.q[i], i - 2);
      state.qd[i] = i < 2 ? StateJet(at.qd[i]) : StateJet(at.qd[i], i);
    }
    const Vector4<StateJet> force =
        InverseDynamics<StateJet>(body, state, Vector4<StateJet>(a.cast<StateJet>()));
    Matrix4<double> expected;
    for (int i = 0; i < 4; ++i) expected.row(i) = force[i].v.transpose();
    ExpectClose(InverseDynamicsJacobian<double>(body, Angles<double>(at.q), at.qd, a), expected,
                1e-12, 100.0);
  }
}

}  // namespace
}  // namespace pushid
