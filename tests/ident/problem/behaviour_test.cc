// Models that settle after a push, and models that walk away or fall.
#include "ident/problem/behaviour.h"

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <Eigen/Core>

#include "datasets/files/random.h"
#include "datasets/loading/load_recordings.h"
#include "datasets/synthetic/synthetic_recordings.h"
#include "ident/fit/fit.h"
#include "ident/model/fitted_model.h"
#include "ident/parameters/presets.h"
#include "ident/report/report_text.h"
#include "models/decompositions.h"
#include "models/rollout.h"
#include "tests/ident/fit_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

// With friction of its own along y, so that what happens along x decides.
ModelOptions Anisotropic() {
  ModelOptions options;
  options.friction = FrictionKind::kAnisotropic;
  return options;
}

// Somewhat more friction than identified, with which the hardest push, 80 N s on 60 kg, is over
// within two seconds as well.
ParameterSet<double> FirmParameters() {
  ParameterSet<double> p = PublishedTailParameters();
  p[kMu] = 60.0;
  p[kMuY] = 100.0;
  return p;
}

Behaviour Of(const ParameterSet<double>& parameters) {
  return ComputeBehaviour(Anisotropic(), parameters);
}

// Five who touch: it takes them longer than one.
TEST(SettlingSeconds, TheSlowestOfAllWhoAreHeldToIt) {
  ModelOptions alone, together;
  together.interaction.spring = together.interaction.damping = true;
  ParameterSet<double> parameters = FirmParameters();
  parameters[kContactStiffness] = 2000.0;
  parameters[kContactDistance] = 0.4;
  parameters[kContactDamping] = 100.0;
  const double one = SettlingSeconds(alone, parameters);
  EXPECT_GT(one, 0.2);
  EXPECT_LT(one, 2.0);
  EXPECT_GT(SettlingSeconds(together, parameters), one);
}

TEST(Behaviour, FirmGainsSettle) {
  const Behaviour b = Of(FirmParameters());
  ASSERT_EQ(b.simulations.size(), 9u);  // 60, 80, 100 kg after 4, 25, 80 N s
  for (const SettlingSimulation& d : b.simulations) {
    EXPECT_TRUE(d.settled) << d.mass << " kg, " << d.impulse << " N s: " << d.speed << " m/s, "
                           << d.lean << " rad";
    EXPECT_FALSE(d.fell);
    EXPECT_GT(d.distance, 0.0);
  }
  EXPECT_TRUE(b.settles);
  EXPECT_FALSE(b.self_propelling);
  EXPECT_LT(b.fastest_growth, 0.0);
}

TEST(Behaviour, IdentifiedGainsSettle) {
  ParameterSet<double> p = FirmParameters();
  p[kMu] = PublishedTailParameters()[kMu];
  const Behaviour b = Of(p);
  EXPECT_LT(b.fastest_growth, 0.0);
  for (const SettlingSimulation& d : b.simulations) {
    EXPECT_TRUE(d.settled) << d.mass << " kg, " << d.impulse;
  }
}

// A network that plays a gain moves the free modes as that gain does.
TEST(Behaviour, FreeModesKnowTheNetwork) {
  constexpr double kSmall = 1e-6;
  LearnedTerms network{{NetworkKind::kMlp, 1}, {}};
  network.weights.assign(network.shape.num_weights(), 0.0);
  network.weights[0] = kSmall;                                     // e_theta
  network.weights[network.shape.output_at() + 2] = -0.1 / kSmall;  // torque
  ModelOptions options = Anisotropic();
  options.learned = std::make_shared<const LearnedTerms>(network);
  ParameterSet<double> p = FirmParameters();
  p[kKpTheta] = 1560.0, p[kAx] = -9.2;  // the slowest mode leans, and knows its stiffness
  ParameterSet<double> stiffer = p;
  const GainScale scale(options.gain_scaling, {80.0, kReferenceRod, 0.0});
  stiffer[kKpTheta] += 0.1 * kNetworkAcceleration * 80.0 / kNetworkAngle / scale.stiffness;
  const double played = ComputeBehaviour(options, p).fastest_growth;
  EXPECT_NEAR(played, Of(stiffer).fastest_growth, 1e-6);
  EXPECT_GT(std::abs(played - Of(p).fastest_growth), 1e-3);
}

TEST(Behaviour, HarderPushesGoFarther) {
  const Behaviour b = Of(FirmParameters());
  for (int mass = 0; mass < 3; ++mass) {
    const SettlingSimulation* d = &b.simulations[3 * mass];
    EXPECT_LT(d[0].distance, d[1].distance);
    EXPECT_LT(d[1].distance, d[2].distance);
  }
}

TEST(Behaviour, NegativeDampingIsSelfPropelling) {
  ParameterSet<double> p = FirmParameters();
  p[kMu] = -60.0;
  const Behaviour b = Of(p);
  EXPECT_TRUE(b.self_propelling);
  EXPECT_GT(b.fastest_growth, 0.0);
  EXPECT_FALSE(b.settles);
  // By c_x, not by mu alone: with a cart gain that makes up for it all is well.
  p[kKpX] = 60.0 + FirmParameters()[kMu];
  EXPECT_TRUE(Of(p).settles);
  EXPECT_FALSE(Of(p).self_propelling);
}

TEST(Behaviour, TooSoftABalanceFalls) {
  ParameterSet<double> p = FirmParameters();
  p[kKpTheta] = p[kKpPhi] = 100.0;  // m g l is about 670 N m/rad
  const Behaviour b = Of(p);
  EXPECT_GT(b.fastest_growth, 0.5);
  EXPECT_FALSE(b.settles);
  EXPECT_TRUE(b.simulations.back().fell);
}

// The growth of one step of the rollout itself, linearized by Jets about rest.
double GrowthOfTheRollout(const ModelOptions& options, const ParameterSet<double>& p) {
  using Jet = ceres::Jet<double, 8>;  // theta, phi, qd, the cart's velocity a step before
  std::vector<ParameterSet<Jet>> parameters(1);
  for (int i = 0; i < kNumParameters; ++i) parameters[0][i] = Jet(p[i]);
  const Scene scene = SettlingScene(80.0, 0.0);
  constexpr int kAfterThePush = 100;
  PendulumState<Jet> state;
  Vector4<Jet> previous = Vector4<Jet>::Zero();
  for (int i = 0; i < 2; ++i) state.q[2 + i] = Jet(0.0, i);
  for (int i = 0; i < 4; ++i) state.qd[i] = Jet(0.0, 2 + i);
  for (int i = 0; i < 2; ++i) previous[i] = Jet(0.0, 6 + i);
  ModelStep<Jet> forces(scene, options, parameters);
  std::vector<int> scratch;
  forces.Update(&state);
  forces.Prepare(0, &scratch);
  const NetForce<Jet> force = forces.On(0, kAfterThePush, previous);
  const PendulumState<Jet> next = forces.Next(0, forces.AccelerationOf(0, force), force, previous);
  Eigen::Matrix<double, 8, 8> step = Eigen::Matrix<double, 8, 8>::Zero();
  for (int i = 0; i < 2; ++i) step.row(i) = next.q[2 + i].v.transpose();
  for (int i = 0; i < 4; ++i) step.row(2 + i) = next.qd[i].v.transpose();
  step(6, 2) = step(7, 3) = 1.0;
  return std::log(SpectralRadius(step)) / scene.dt;
}

TEST(Behaviour, GrowthIsThatOfTheLinearizedRollout) {
  Random random(12);
  for (int trial = 0; trial < 40; ++trial) {
    ModelOptions options = Anisotropic();
    options.posture = trial % 2 == 0 ? Posture::kInitial : Posture::kUpright;
    options.gain_scaling = static_cast<GainScaling>(trial % 3);
    if (trial % 4 == 3) options.stance = Stance::kSteps;
    ParameterSet<double> p = FirmParameters();
    p[kSupportFront] = p[kSupportBack] = p[kSupportSide] = 0.1, p[kFootFront] = 0.2;
    p[kStepGain] = 1.0, p[kStepOnset] = p[kStepSwing] = 0.3;
    p[kMu] = random.Uniform(-40, 60), p[kMuY] = random.Uniform(20, 60);
    for (Parameter id : {kAx, kAy}) p[id] = random.Uniform(-15, 2);
    for (Parameter id : {kBx, kBy, kTx, kTy, kKdX, kKdY}) p[id] = random.Uniform(-1, 1);
    for (Parameter id : {kCq, kDq}) p[id] = random.Uniform(0, 1);
    for (CartDerivative derivative : {CartDerivative::kNone, CartDerivative::kBackward}) {
      options.cart_derivative = derivative;
      EXPECT_NEAR(ComputeBehaviour(options, p).fastest_growth, GrowthOfTheRollout(options, p),
                  1e-9);
    }
  }
}

// Five in a line, the pushed one thrown back by the contact: the signed means say so.
TEST(Behaviour, MovesAreSignedAlongThePush) {
  ModelOptions options = Anisotropic();
  options.interaction.spring = options.interaction.damping = true;
  ParameterSet<double> p = FirmParameters();
  p[kContactStiffness] = 2900.0, p[kContactDistance] = 0.47, p[kContactKappa] = 0.45;
  p[kContactDamping] = 200.0, p[kContactHeight] = 0.5;
  p[kAx] = -18.0, p[kMu] = 8.0;
  const Behaviour b = ComputeBehaviour(options, p);
  ASSERT_EQ(b.simulations.size(), 12u);
  for (const SettlingSimulation& d : b.simulations) {
    if (d.people == 1) {
      EXPECT_EQ(d.advance, d.pushed_advance);
      EXPECT_NEAR(std::abs(d.advance), d.distance, 1e-3);
    }
    EXPECT_LE(std::abs(d.advance), d.distance + 1e-12);
  }
  const SettlingSimulation& hardest = b.simulations.back();
  EXPECT_LT(hardest.pushed_advance, 0.0);
  EXPECT_LT(hardest.advance, 0.9 * hardest.distance);
  ASSERT_NE(b.FarthestBehind(), nullptr);
  EXPECT_LE(b.FarthestBehind()->pushed_advance, hardest.pushed_advance);
  EXPECT_EQ(Of(FirmParameters()).FarthestBehind(), nullptr);
}

TEST(Behaviour, LinesThatGoBackDoNotMoveOnFarther) {
  Behaviour b;
  SettlingSimulation weak, hard;
  weak.people = hard.people = kLinePeople;
  weak.setting = hard.setting = "row";
  weak.advance = -0.01, hard.advance = -0.3, hard.pushed_advance = -0.6;
  weak.distance = 0.01, hard.distance = 0.4;
  b.simulations = {weak, hard};
  b.harder_moves_farther = false;
  FitResult result;
  result.behaviour = b;
  const std::string text = BehaviourText(result) + BehaviourTable(result).ToString();
  EXPECT_TRUE(Contains(text, "does NOT move the line farther: row"));
  EXPECT_TRUE(Contains(text, "-0.3"));
  EXPECT_TRUE(Contains(text, "-0.6"));
}

// Upright, friction and damping off along x: the cart's speed neither grows nor fades.
TEST(Behaviour, AnUndampedCartIsMarginal) {
  ParameterSet<double> p = FirmParameters();
  p[kMu] = p[kKpX] = p[kAx] = 0.0;
  const Behaviour b = Of(p);
  EXPECT_NEAR(b.fastest_growth, 0.0, 1e-6);
  EXPECT_FALSE(b.settles);
}

TEST(Behaviour, AFitThatIsNotHeldToSettleSaysSo) {
  SyntheticOptions study;
  study.parameters[kMu] = -50.0;
  study.frames = 50;
  const auto made = Unwrapped(MakeSyntheticRecordings(study));
  std::vector<PendulumRecording> recordings;
  for (const Recording& r : Recordings(made)) {
    recordings.push_back(MakePendulumRecording(r));
  }
  FitOptions options;
  options.model = study.model;
  options.table = MakePreset("tail").value().table;
  for (ParameterSpec& spec : options.table.specs) {
    if (!spec.free) spec.nominal = study.parameters[spec.id];
    spec.pooled = false;
  }
  const FitResult walking = Fit(recordings, options);
  ASSERT_TRUE(walking.ok());
  EXPECT_TRUE(walking.behaviour.self_propelling);
  bool warned = false;
  for (const Warning& w : walking.warnings) {
    warned = warned || w.text.find("self-propelling") == 0;
  }
  EXPECT_TRUE(warned);
}

// The trap in the published data: least squares makes people drive themselves, and must say so.
TEST(Behaviour, PlainPdOnRealRecordingsIsSelfPropelling) {
  if (RecordingsRoot().empty()) GTEST_SKIP() << kNoRecordings;
  LoadOptions load;
  load.setting = "single";
  const auto loaded = Unwrapped(LoadRecordings(RecordingsRoot() + "/manifest.json", load));
  const FitOptions preset = MakePreset("ldp").value();
  FitOptions options;
  options.model = preset.model;
  options.model.friction = FrictionKind::kAnisotropic;
  options.model.gain_scaling = GainScaling::kMass;
  options.table = preset.table;
  options.table[kMuY].free = true;
  const FitResult result = Fit(AsPendulums(loaded), options);
  ASSERT_TRUE(result.ok());
  EXPECT_TRUE(result.behaviour.self_propelling);
  EXPECT_LT(result.derived[0].value, 0.0) << result.derived[0].name;
}

}  // namespace
}  // namespace pushid
