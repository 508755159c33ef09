// The rod as a state: LDP's law by hand, the constant rod as the limit of zero weights, and what a
// rod that moved does to the pendulum.
#include <ceres/jet.h>

#include "models/formation.h"
#include "models/learned_terms.h"
#include "models/rollout.h"
#include "tests/models/model_samples.h"

namespace pushid {
namespace {

std::vector<RodShape> EveryLaw() {
  return {{RodKind::kLdp, {4}}, {RodKind::kLdp, {3, 2}}, {RodKind::kLdp, {2, 4, 3}}};
}

std::vector<double> RandomWeights(int count, double size, Random* random) {
  std::vector<double> weights;
  for (int i = 0; i < count; ++i) weights.push_back(random->Uniform(-size, size));
  return weights;
}

TEST(RodLaw, SizesAndNames) {
  const RodShape constant;
  EXPECT_EQ(constant.num_weights(), 0);
  const RodShape ldp{RodKind::kLdp, {128, 128}};  // the mass among the inputs, all biases
  EXPECT_EQ(ldp.num_weights(), 18305);            // 128 13 + 128 129 + 129
  EXPECT_EQ(RodName(constant), "constant");
  EXPECT_EQ(RodName(ldp), "ldp:128-128");
}

// One unit that sees the length and the mass: h = max(0, (l - 0.95) / 0.05 + 2 (M - 85) / 20 +
// 0.5), dl/dt = 0.1 (3 h - 1).
TEST(RodLaw, LdpsSeesLengthAndMass) {
  const RodShape shape{RodKind::kLdp, {1}};
  std::vector<double> weights(shape.num_weights(), 0.0);
  ASSERT_EQ(weights.size(), 15u);
  weights[10] = 1.0, weights[11] = 2.0, weights[12] = 0.5, weights[13] = 3.0, weights[14] = -1.0;
  const auto velocity = [&](double mass, double rod) {
    const Eigen::VectorXd inputs =
        RodInputs<double>(0.1, 0.2, {1, 2, 3, 4}, {5, 6, 7, 8}, rod, {mass, 0.9, 0.1});
    return RodVelocity(shape, weights.data(), inputs);
  };
  EXPECT_NEAR(velocity(85.0, 0.05), 0.1 * (3.0 * 0.5 - 1.0), 1e-14);
  EXPECT_NEAR(velocity(95.0, 0.05), 0.1 * (3.0 * 1.5 - 1.0), 1e-14);
  EXPECT_NEAR(velocity(85.0, 0.0), -0.1, 1e-14) << "rectified";
}

// LDP's Eq. 7: the self force that the rod sees is PD and LSTM, without the ground's friction.
// A person of 95 kg and l = 1.0 + 0.02 m, theta = 0.1, phi = 0.05, v = (0.5, -0.2), (0.4, -0.2) a
// frame earlier, thd = 0.2; an LSTM that says 170 (0.02, 0, -0.1, 0) = (3.4, 0, -17, 0):
//   x      -30 0.5 - 4 per frame (0.5 - 0.4) + 3.4 = -12 N     (a friction of -50 N left out)
//   y      30 0.2 = 6 N
//   theta  -1500 0.1 - 10 0.2 - 17 = -169 N m
//   phi    -1500 0.05 = -75 N m
// each over 2 95 kg. One unit that sees one of the inputs, far from where it is rectified, tells
// it.
TEST(RodLaw, LdpsInputsByHand) {
  LearnedTerms learned;
  learned.shape = {NetworkKind::kLdp, 1, 1};
  learned.rod = {RodKind::kLdp, {1}};
  learned.weights.assign(learned.num_weights(), 0.0);
  learned.weights[learned.shape.output_at() + 1] = 0.02;
  learned.weights[learned.shape.output_at() + 5] = -0.1;
  double* const of_rod = learned.weights.data() + learned.rod_at();
  of_rod[RodShape::kInputs] = 10.0;  // its b, o and c
  of_rod[RodShape::kInputs + 1] = 1.0, of_rod[RodShape::kInputs + 2] = -10.0;
  ModelOptions options;
  options.posture = Posture::kUpright;
  options.gain_scaling = GainScaling::kNone;
  options.cart_derivative = CartDerivative::kBackward;
  ParameterSet<double> p{};
  p[kMu] = 100.0, p[kKpX] = p[kKpY] = 30.0, p[kKdX] = p[kKdY] = 4.0 / 60.0;
  p[kKpTheta] = p[kKpPhi] = 1500.0, p[kKdTheta] = p[kKdPhi] = 10.0;
  Scene scene;
  scene.people = {{{95.0, 1.0, 0.1}, {}}};
  PendulumState<double> now{{3.0, 4.0, 0.1, 0.05}, {0.5, -0.2, 0.2, 0.0}};
  now.rod = 0.02;

  const std::vector<ParameterSet<double>> parameters = {p};
  Eigen::VectorXd by_hand(RodShape::kInputs);
  by_hand << 0.1 / 0.15, 0.05 / 0.15, 0.5 / 0.8, -0.2 / 0.8, 0.2 / 0.6, 0.0, -12.0 / 190.0,
      6.0 / 190.0, -169.0 / 190.0, -75.0 / 190.0, 1.4, 0.5;
  for (int i = 0; i < RodShape::kInputs; ++i) {
    LearnedTerms sees = learned;
    sees.weights[learned.rod_at() + i] = 1.0;
    options.learned = std::make_shared<LearnedTerms>(sees);
    ModelStep<double> forces(scene, options, parameters);
    forces.Update(&now);
    forces.PrepareAll();
    const PendulumState<double> next =
        forces.Next(0, Vector4<double>::Zero(), {}, {0.4, -0.2, 0.0, 0.0});
    EXPECT_NEAR((next.rod - now.rod) / (scene.dt * kRodSpeed), by_hand[i], 1e-12) << i;
  }
}

ParameterSet<double> RodParameters() {
  ParameterSet<double> p{};
  p[kMu] = 40.0, p[kKpTheta] = p[kKpPhi] = 1700.0, p[kKdTheta] = p[kKdPhi] = 90.0;
  p[kAx] = p[kAy] = -9.0, p[kTailGain] = 1.0, p[kTailTorque] = 0.3, p[kTailTime] = 0.2;
  p[kTailExponent] = 1.5;
  return p;
}

// Two people who lean a little, the first of them pushed.
Scene TwoPeople(double push) {
  Scene scene = SettlingScene(70.0, push, 2);
  scene.people[0].start.q[2] = 0.03, scene.people[1].start.q[3] = -0.02;
  return scene;
}

// size: of the rod's weights; the self force, where there is one, has its own.
ModelOptions WithRod(const RodShape& rod, const NetworkShape& self, double size, Random* random) {
  auto network = std::make_shared<LearnedTerms>();
  network->shape = self;
  network->rod = rod;
  network->weights = RandomWeights(self.num_weights(), 0.3, random);
  for (double w : RandomWeights(rod.num_weights(), size, random)) network->weights.push_back(w);
  ModelOptions options;
  options.learned = network;
  return options;
}

RolloutPath<double> RollStanding(const Scene& scene, const ModelOptions& options, int frames) {
  RolloutPath<double> path;
  const RolloutStatus status =
      Rollout<double>(scene, options, {RodParameters()}, InitialVelocities(scene), frames, &path);
  EXPECT_TRUE(status.ok) << status.quantity;
  return path;
}

const NetworkShape kNoNetwork, kLdps{NetworkKind::kLdp, 3, 2}, kMotionMlp{NetworkKind::kMlp, 3};

TEST(RodLaw, ZeroWeightsAreAConstantRodToTheLastBit) {
  Random random(73);
  const Scene scene = TwoPeople(40.0);
  for (const NetworkShape& self : {kNoNetwork, kLdps, kMotionMlp}) {
    for (const RodShape& shape : EveryLaw()) {
      const ModelOptions moving = WithRod(shape, self, 0.0, &random);
      auto network = std::make_shared<LearnedTerms>(*moving.learned);
      network->rod = {};
      ModelOptions constant;
      if (self.any()) constant.learned = network;
      const auto path = RollStanding(scene, moving, 120),
                 expected = RollStanding(scene, constant, 120);
      for (int t = 0; t < 120; ++t) {
        for (int n = 0; n < 2; ++n) {
          ASSERT_EQ(path.At(t, n).q, expected.At(t, n).q) << RodName(shape) << " frame " << t;
          ASSERT_EQ(path.At(t, n).qd, expected.At(t, n).qd);
          ASSERT_EQ(path.At(t, n).rod, 0.0);
        }
      }
    }
  }
}

TEST(RodLaw, APushMovesTheRodAndTheRodThePendulum) {
  Random random(74);
  const Scene scene = TwoPeople(40.0);
  for (const RodShape& shape : EveryLaw()) {
    const auto path = RollStanding(scene, WithRod(shape, kNoNetwork, 0.6, &random), 40);
    const auto constant = RollStanding(scene, {}, 40);
    EXPECT_GT(std::abs(path.At(39, 0).rod), 1e-6) << RodName(shape);
    EXPECT_GT((path.At(39, 0).q - constant.At(39, 0).q).norm(), 1e-6) << RodName(shape);
  }
}

TEST(RodLaw, LdpsSizeRunsInARollout) {
  Random random(75);
  const RodShape ldp{RodKind::kLdp, {128, 128}};
  const auto path = RollStanding(TwoPeople(40.0), WithRod(ldp, kMotionMlp, 0.05, &random), 60);
  EXPECT_NE(path.At(59, 0).rod, 0.0);
}

// Weights on the length alone make it grow without end.
TEST(RodLaw, AFailureNamesTheRod) {
  LearnedTerms network;
  network.rod = {RodKind::kLdp, {1}};
  network.weights.assign(network.num_weights(), 0.0);
  network.weights[RodShape::kRodInput] = 5.0;
  network.weights[RodShape::kInputs] = network.weights[RodShape::kInputs + 1] = 1.0;
  ModelOptions options;
  options.learned = std::make_shared<LearnedTerms>(network);
  const Scene scene = TwoPeople(40.0);
  RolloutPath<double> path;
  const RolloutStatus status =
      Rollout<double>(scene, options, {RodParameters()}, InitialVelocities(scene), 200, &path);
  ASSERT_FALSE(status.ok);
  EXPECT_EQ(status.quantity, "rod");
  EXPECT_EQ(status.person, 0);
  const double length = scene.people[0].body.rod_length + path.At(status.frame, 0).rod;
  EXPECT_TRUE(length < kShortestRod || length > kLongestRod);
  // One that does not move may have any length.
  EXPECT_EQ(OutsideDomain(Body{70.0, 0.2, 0.0}, PendulumState<double>{}), "");
}

TEST(RodLaw, AMovedRodIsARodOfThatLength) {
  Random random(77);
  for (int i = 0; i < 20; ++i) {
    const Body body = RandomBody(&random);
    PendulumState<double> state = RandomState(&random, 0.3);
    state.rod = random.Uniform(-0.2, 0.2);
    const Body now = BodyNow(body, state.rod);
    EXPECT_EQ(now.rod_length, body.rod_length + state.rod);
    EXPECT_EQ(now.mass, body.mass);
    // Upright, the hip sinks by what the rod loses.
    const double height = HipPosition<double>(now, {0, 0, 0, 0}).z();
    EXPECT_NEAR(height, body.cart_height + body.rod_length + state.rod, 1e-14);
    EXPECT_EQ(Step(state, RandomVector(&random, 1.0), 0.01).rod, state.rod);
  }
}

}  // namespace
}  // namespace pushid
