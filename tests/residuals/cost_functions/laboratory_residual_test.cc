// Delays, moving ground, platforms and bodies other than LDP's: derivatives against differences
// through the whole rollout, in three regimes; what platforms say of a motion, by hand.
#include "models/turn.h"
#include "residuals/jets/autodiff_rollout.h"
#include "tests/residuals/residual_samples.h"

namespace pushid {
namespace {

constexpr int kFrames = 40;

// Ground that is shifted and tilted a little.
GroundMotion RandomGround(double size, double dt, Random* random) {
  std::vector<GroundPose> poses(kFrames, GroundPose::Zero());
  const Vector4<double> direction{1.0, random->Uniform(-0.5, 0.5), random->Uniform(-0.3, 0.3),
                                  random->Uniform(-0.3, 0.3)};
  for (int t = 3; t < kFrames; ++t) {
    poses[t] = poses[t - 1] + size * std::sin(0.3 * (t - 3)) * dt * direction;
  }
  return GroundThrough(poses, dt);
}

PendulumRecording OnThePlate(const ModelOptions& options, double lean, double push, double noise,
                             Random* random) {
  Scene scene = SceneOfPeople(1, lean, random);
  scene.pushes = {RandomPush(0, 5, 6, PushKind::kExternal, push, random),
                  RandomPush(0, 22, 4, PushKind::kNet, 0.5 * push, random)};
  scene.ground = RandomGround(push / 150.0, scene.dt, random);
  PendulumRecording recording = RecordRollout(scene, options, {RecoveringParameters()}, kFrames);
  AddNoise(noise, random, &recording);
  recording.plates.emplace_back();
  for (int t = 0; t < kFrames; ++t) {
    recording.plates[0].push_back({{random->Normal(0.0, push), random->Normal(0.0, push)},
                                   {random->Normal(0.0, 0.02), random->Normal(0.0, 0.02)},
                                   t % 7 == 3 ? 0.0 : random->Uniform(0.5, 1.0)});
  }
  return recording;
}

std::vector<ModelOptions> LaboratoryModels() {
  std::vector<ModelOptions> all;
  for (Stance stance : {Stance::kSlide, Stance::kSteps, Stance::kFixed})
    for (Delay delay : {Delay::kNone, Delay::kOne, Delay::kAnkleAndStep})
      for (PushUse use : {PushUse::kAsRecorded, PushUse::kAdded})
        for (Posture posture : {Posture::kUpright, Posture::kInitial}) {
          ModelOptions options;
          options.stance = stance;
          options.delay = delay;
          options.push = use;
          options.posture = posture;
          all.push_back(options);
          if (stance != Stance::kSlide) continue;
          options.friction = FrictionKind::kCoulomb;
          options.body = BodyModel::kTable;
          all.push_back(options);
        }
  return all;
}

struct LaboratoryRegime {
  std::string name;
  double lean, push, velocity, noise, spread, absolute;
};

class LaboratoryTwins : public testing::TestWithParam<LaboratoryRegime> {};

TEST_P(LaboratoryTwins, DerivativesEqualDifferences) {
  const LaboratoryRegime& regime = GetParam();
  Random random(51);
  const ParameterMap map = EveryParameterMap({kKpTheta, kReactionDelay});
  for (const ModelOptions& options : LaboratoryModels()) {
    SCOPED_TRACE(Describe(options) + ", delay " + NameOf(options.delay).data());
    PendulumRecording recording =
        OnThePlate(options, regime.lean, regime.push, regime.noise, &random);
    recording.initial_velocity = InitialVelocity::kFree;
    ResidualSigmas sigmas;
    sigmas.robust = random.Unit() < 0.3 ? 0.0 : 1.0;
    const auto problem = MakeRolloutProblem(recording, options, map, sigmas, 0.7, 0);
    ASSERT_EQ(problem->num_plate_rows(), (kFrames - 1) * kPlateResiduals);
    const ParameterBlocks blocks =
        RandomBlocks(map, problem->layout, RandomRecoveringParameters(&random, regime.spread), 0.05,
                     regime.velocity, &random);
    ExpectDirectionalDerivatives(AutoDiffRollout(problem), blocks, {1e-6, regime.absolute, 0.0});
    if (HasFailure()) return;
  }
}

INSTANTIATE_TEST_SUITE_P(
    ThreeRegimes, LaboratoryTwins,
    testing::Values(LaboratoryRegime{"at_rest", 0.0, 0.0, 0.0, 0.0, 0.0, 1e-11},
                    LaboratoryRegime{"tiny", 0.0, 1e-6, 1e-8, 1e-8, 0.2, 1e-12},
                    LaboratoryRegime{"large", 0.05, 120.0, 0.2, 0.03, 0.2, 1e-10}),
    [](const auto& test) { return test.param.name; });

// Jets share the rollout's lines; differences share nothing.
TEST(LaboratoryResidual, JacobianAgainstNumericDifferentiation) {
  Random random(52);
  ModelOptions options;
  options.stance = Stance::kFixed;
  options.delay = Delay::kOne;
  const ParameterMap map = EveryParameterMap({});
  const PendulumRecording recording = OnThePlate(options, 0.05, 60.0, 0.02, &random);
  const auto problem = MakeRolloutProblem(recording, options, map, {}, 1.0, 0);
  ExpectCorrectJacobian(AutoDiffRollout(problem), {SharedBlock(map, RecoveringParameters())},
                        {1e-6, 1e-7, 1e-12});
}

// A delay of whole frames is a look back, and one of none is none.
TEST(ReactionDelay, OfWholeFramesLooksBack) {
  RolloutPath<double> path(8, 1);
  for (int t = 0; t < 8; ++t) {
    path.At(t, 0).q = Vector4<double>(0.0, 0.0, 0.1 * t * t, -0.2 * t);
    path.At(t, 0).qd = Vector4<double>::Constant(t);
  }
  constexpr double kStep = 0.01;
  for (int back = 0; back <= 7; ++back) {
    const DelayedState<double> then(path, 7, 0, DelayedPlace<double>(back * kStep, kStep));
    EXPECT_NEAR(then.q[2], 0.1 * (7 - back) * (7 - back), 1e-12);
    // qd of a frame is the rate half a frame before it.
    if (back > 0) {
      EXPECT_NEAR(then.qd[0], 7.5 - back, back < 6 ? 1e-12 : 0.1);
    }
  }
  EXPECT_NEAR(PresentRate(path, 7, 0)[0], 7.5, 1e-12);
  // Between frames a straight line stays one.
  const DelayedState<double> between(path, 7, 0, DelayedPlace<double>(2.3 * kStep, kStep));
  EXPECT_NEAR(between.q[3], -0.2 * 4.7, 1e-12);
  // Before frame 0: at rest in the first posture.
  const DelayedState<double> before(path, 7, 0, DelayedPlace<double>(50 * kStep, kStep));
  EXPECT_EQ(before.q, path.At(0, 0).q);
  EXPECT_TRUE(before.qd.isZero(0.0));
}

// A quiet person presses the ground where the centre of mass is, and does not shear it.
TEST(PlateResidual, CentreOfWhoIsQuietIsThatOfTheMass) {
  ModelOptions options;
  options.stance = Stance::kFixed;
  ParameterSet<double> p = RecoveringParameters();
  const Body body{80.0, 0.9, 0.08};
  PendulumState<double> state;
  state.q = {0.3, -0.1, 0.03, -0.02};
  const BodyOf<double> standing = StandingBody<double>(body, p[kComHeight]);
  const Vector4<double> none = Vector4<double>::Zero();
  const PlateVector<double> r = GroundReaction<double>(standing, state, none, GroundStep{}, none);
  EXPECT_NEAR(r[0], 0.0, 1e-12);
  EXPECT_NEAR(r[1], 0.0, 1e-12);
  const double height = kMassAboveAnkles * p[kComHeight] * 0.9;
  EXPECT_NEAR(r[2], 0.3 + height * std::sin(0.03) * std::cos(0.02), 1e-9);
  EXPECT_NEAR(r[3], -0.1 + height * std::cos(0.03) * std::sin(0.02), 1e-9);
}

// Carried along on ground that accelerates, a body shears it by its mass times the acceleration,
// and the centre goes back by the height of the centre of mass.
TEST(PlateResidual, ShearCarriesTheBodyAlong) {
  const Body body{80.0, 0.9, 0.0};
  const BodyOf<double> standing = StandingBody<double>(body, kComOverHip);
  GroundStep ground;
  ground.acceleration[0] = 0.5;
  const Vector4<double> none = Vector4<double>::Zero();
  const PlateVector<double> r =
      GroundReaction<double>(standing, PendulumState<double>(), none, ground, none);
  EXPECT_NEAR(r[0], 40.0, 1e-12);
  EXPECT_NEAR(r[2], -kMassAboveAnkles * kComOverHip * 0.9 * 0.5 / kGravity, 1e-12);
}

// Mass, first moment and inertia about the ankles are the body's.
TEST(MassDistribution, MovesLikeTheBody) {
  const MassDistribution masses{0.2, 0.6, 0.3};
  const Body body{50.0, 1.1, 0.0};
  const Body point = Distributed<double>(body, masses);
  EXPECT_NEAR(point.point_mass() * point.pendulum_length(), 40.0 * 0.6 * 1.1, 1e-12);
  EXPECT_NEAR(point.point_mass() * point.pendulum_length() * point.pendulum_length(),
              40.0 * (0.36 + 0.09) * 1.21, 1e-12);
  EXPECT_EQ(point.mass, 50.0);
  EXPECT_EQ(point.rod_length, 1.1);
}

// Ground that accelerates for ever cannot be told from ground that is tilted.
TEST(Ground, ConstantAccelerationIsTiltedGravity) {
  Scene tilted = SceneOfPeople(1, 0.0, std::make_unique<Random>(3).get());
  Scene shifted = tilted;
  const double tilt = 0.05;
  tilted.ground = GroundThrough(std::vector(60, GroundPose(0.0, 0.0, tilt, 0.0)), tilted.dt);
  tilted.ground.steps[0] = tilted.ground.steps[1];
  shifted.ground = tilted.ground;
  GroundStep accelerated;
  accelerated.acceleration[0] = -kGravity * std::sin(tilt);
  accelerated.gravity = kGravity * std::cos(tilt);
  shifted.ground.steps.assign(60, accelerated);
  for (Stance stance : {Stance::kSlide, Stance::kFixed}) {
    ModelOptions options;
    options.stance = stance;
    RolloutPath<double> a, b;
    for (auto [scene, path] : {std::pair(&tilted, &a), std::pair(&shifted, &b)}) {
      ASSERT_TRUE(Rollout<double>(*scene, options, {RecoveringParameters()},
                                  InitialVelocities(*scene), 60, path)
                      .ok);
    }
    EXPECT_GT(std::abs(a.At(59, 0).q[2]), 1e-3);
    for (int t = 0; t < 60; ++t) EXPECT_LT((a.At(t, 0).q - b.At(t, 0).q).norm(), 1e-12) << t;
  }
}

// Someone who slides without friction and balances nothing stays where they are in the laboratory.
TEST(Ground, WithoutForcesThePersonStaysInTheLaboratory) {
  Random random(5);
  Scene scene = SceneOfPeople(1, 0.0, &random);
  scene.people[0].start.q.setZero();
  scene.ground = RandomGround(0.3, scene.dt, &random);
  for (GroundPose& pose : scene.ground.poses) pose[2] = pose[3] = 0.0;
  scene.ground = GroundThrough(scene.ground.poses, scene.dt);
  RolloutPath<double> path;
  ASSERT_TRUE(
      Rollout<double>(scene, {}, {ParameterSet<double>{}}, InitialVelocities(scene), kFrames, &path)
          .ok);
  EXPECT_GT(scene.ground.poses.back().norm(), 0.01);
  for (int t = 0; t < kFrames; ++t) {
    EXPECT_LT(
        InLaboratory(scene.ground, t, Vector3<double>::Zero(), path.At(t, 0)).q.head<2>().norm(),
        1e-12)
        << t;
  }
}

}  // namespace
}  // namespace pushid
