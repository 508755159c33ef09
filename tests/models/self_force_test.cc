// The self force: symmetries, scalings.
#include "models/self_force.h"

#include "tests/models/model_samples.h"

namespace pushid {
namespace {

std::vector<ModelOptions> EveryModel() {
  std::vector<ModelOptions> models;
  for (Posture posture : {Posture::kUpright, Posture::kInitial}) {
    for (GainScaling scaling : {GainScaling::kNone, GainScaling::kMass, GainScaling::kBody}) {
      for (FrictionKind friction : {FrictionKind::kIsotropic, FrictionKind::kAnisotropic}) {
        for (CartDerivative derivative : {CartDerivative::kNone, CartDerivative::kBackward}) {
          ModelOptions options;
          options.posture = posture;
          options.gain_scaling = scaling;
          options.friction = friction;
          options.cart_derivative = derivative;
          models.push_back(options);
        }
      }
    }
  }
  return models;
}

// Turned by 90 degrees about z (first order in the angles, which is what the self force sees):
// x' = -y, y' = x, and since a lean towards x is theta > 0 but one towards y is phi < 0,
// theta' = phi, phi' = -theta. Forces turn like coordinates.
Vector4<double> Turn(const Vector4<double>& v) { return {-v[1], v[0], v[3], -v[2]}; }

TEST(SelfForce, TurnedPhysicsGivesTurnedForces) {
  Random random(10);
  for (const ModelOptions& options : EveryModel()) {
    ParameterSet<double> p = RandomParameters(&random);
    p[kMuY] = p[kMu];
    for (const auto& [along_x, along_y] : {std::pair{kKpX, kKpY},
                                           {kKpTheta, kKpPhi},
                                           {kKdX, kKdY},
                                           {kKdTheta, kKdPhi},
                                           {kAx, kAy},
                                           {kBx, kBy},
                                           {kTx, kTy}}) {
      p[along_y] = p[along_x];
    }
    const Body body = RandomBody(&random);
    const Vector4<double> q0 = 0.1 * RandomState(&random).q;
    const SelfForce self(options, body, q0, kSampleDt);
    const SelfForce turned_self(options, body, Turn(q0), kSampleDt);
    const PendulumState<double> state = RandomState(&random);
    const Vector4<double> previous = RandomVector(&random, 3.0);
    const PendulumState<double> turned{Turn(state.q), Turn(state.qd)};
    ExpectClose(OwnForce(turned_self, p, turned, Turn(previous)),
                Turn(OwnForce(self, p, state, previous)), 1e-12, 10.0);
  }
}

// The parameters along y do for y and phi what those along x do for x and theta, and nothing else.
TEST(SelfForce, ParametersAlongYActOnYAndPhiAlone) {
  Random random(11);
  ModelOptions options;
  options.friction = FrictionKind::kAnisotropic;
  options.cart_derivative = CartDerivative::kBackward;
  const SelfForce self(options, RandomBody(&random), Vector4<double>::Zero(), kSampleDt);
  const PendulumState<double> state = RandomState(&random);
  const Vector4<double> previous = RandomVector(&random, 3.0);
  const ParameterSet<double> p = RandomParameters(&random);
  const auto moved_by = [&](Parameter i) {
    ParameterSet<double> more = p;
    more[i] += 1.0;
    return Vector4<double>(OwnForce(self, more, state, previous) -
                           OwnForce(self, p, state, previous));
  };
  for (Parameter i : {kMu, kKpX, kKpTheta, kKdX, kKdTheta, kAx, kBx, kTx}) {
    EXPECT_EQ(moved_by(i)[1], 0.0) << kParameterNames[i];
    EXPECT_EQ(moved_by(i)[3], 0.0) << kParameterNames[i];
    EXPECT_GT(moved_by(i).norm(), 0.0) << kParameterNames[i];
  }
  for (Parameter i : {kMuY, kKpY, kKpPhi, kKdY, kKdPhi, kAy, kBy, kTy}) {
    EXPECT_EQ(moved_by(i)[0], 0.0) << kParameterNames[i];
    EXPECT_EQ(moved_by(i)[2], 0.0) << kParameterNames[i];
    EXPECT_GT(moved_by(i).norm(), 0.0) << kParameterNames[i];
  }
}

TEST(SelfForce, IsotropicFrictionIgnoresMuY) {
  ParameterSet<double> p{};
  p[kMu] = 100.0;
  p[kMuY] = 40.0;
  const Body body{kReferenceMass, kReferenceRod, 0.0};
  const Vector4<double> q0 = Vector4<double>::Zero(), qd(0.5, -0.2, 1.0, 1.0);
  ModelOptions options;
  options.friction = FrictionKind::kIsotropic;
  ExpectClose(SelfForce(options, body, q0, kSampleDt).Friction(p, qd),
              Vector4<double>(-50, 20, 0, 0), 1e-14);
  options.friction = FrictionKind::kAnisotropic;
  ExpectClose(SelfForce(options, body, q0, kSampleDt).Friction(p, qd),
              Vector4<double>(-50, 8, 0, 0), 1e-14);
}

TEST(SelfForce, GainsScaleWithTheBodyAsAsked) {
  const Body body{1.5 * kReferenceMass, 1.1 * kReferenceRod, 0.0};
  const GainScale none(GainScaling::kNone, body), mass(GainScaling::kMass, body),
      by_body(GainScaling::kBody, body);
  EXPECT_EQ(none.force * none.stiffness * none.damping, 1.0);
  EXPECT_DOUBLE_EQ(mass.force, 1.5);
  EXPECT_DOUBLE_EQ(mass.stiffness, 1.5);
  EXPECT_DOUBLE_EQ(mass.damping, 1.5);
  EXPECT_DOUBLE_EQ(by_body.force, 1.5);
  EXPECT_DOUBLE_EQ(by_body.stiffness, 1.5 * 1.1);
  EXPECT_DOUBLE_EQ(by_body.damping, 1.5 * 1.1 * 1.1);
  // The reference person is no exception.
  EXPECT_DOUBLE_EQ(GainScale(GainScaling::kBody, Body{}).damping, 1.0);
}

TEST(SelfForce, HeldPostureNeedsNoGain) {
  Random random(12);
  ModelOptions options;
  options.posture = Posture::kInitial;
  const Body body = RandomBody(&random);
  const PendulumState<double> start{{0.3, -0.2, 0.1, -0.05}, Vector4<double>::Zero()};
  const SelfForce self(options, body, start.q, kSampleDt);
  const Vector4<double> force =
      OwnForce(self, RandomParameters(&random), start, Vector4<double>(Vector4<double>::Zero()));
  ExpectClose(Acceleration(body, start, force), Vector4<double>(Vector4<double>::Zero()), 1e-13);
}

TEST(SelfForce, CartDerivativeIsTheBackwardDifference) {
  ParameterSet<double> p{};
  p[kKdX] = 3.0;
  p[kKdY] = 5.0;
  ModelOptions options;
  options.cart_derivative = CartDerivative::kBackward;
  options.gain_scaling = GainScaling::kNone;
  const PendulumState<double> state{Vector4<double>::Zero(), {0.4, 0.1, 0, 0}};
  const Vector4<double> previous(0.3, 0.2, 9, 9);
  const Vector4<double> q0 = Vector4<double>::Zero();
  const Vector4<double> force = SelfForce(options, Body{}, q0, 0.01).Balance(p, state, previous);
  ExpectClose(force, Vector4<double>(-3.0 * 10.0, 5.0 * 10.0, 0.0, 0.0), 1e-12);
  options.cart_derivative = CartDerivative::kNone;
  EXPECT_EQ(SelfForce(options, Body{}, q0, 0.01).Balance(p, state, previous).norm(), 0.0);
}

}  // namespace
}  // namespace pushid
