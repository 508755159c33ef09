// Settling and stability: a person who was pushed settles.
#include "residuals/cost_functions/rest_residual.h"

#include "tests/residuals/residual_samples.h"

namespace pushid {
namespace {

// The tail model of the published recordings, quoted for the reference person.
ParameterSet<double> SensibleGains() {
  ParameterSet<double> p{};
  p[kMu] = 29.0;
  p[kMuY] = 100.0;
  p[kKpTheta] = p[kKpPhi] = 1560.0;
  p[kKdTheta] = p[kKdPhi] = 69.0;
  p[kAx] = -9.2;
  p[kTailGain] = 1.15, p[kTailTorque] = 0.33, p[kTailTime] = 0.19, p[kTailExponent] = 1.55;
  return p;
}

double Cost(const RestProblem& problem, const ParameterBlocks& blocks) {
  const CostEvaluation evaluation = EvaluateCost(SettlingResidual(problem), blocks, {});
  EXPECT_TRUE(evaluation.ok);
  return 0.5 * evaluation.residuals.squaredNorm();
}

PendulumRecording PairPushedOnce(double push, Random* random) {
  Scene scene = SceneOfPeople(2, 0.08, random);
  scene.pushes = {RandomPush(0, 0, 4, PushKind::kNet, push, random),
                  RandomPush(1, 3, 5, PushKind::kExternal, push, random)};
  return RecordRollout(scene, {}, std::vector(2, RecoveringParameters()), 30);
}

// While the person still moves, so that the hinges are open.
TEST(Settling, JacobianAgainstNumericDifferentiation) {
  Random random(51);
  // Pooled parameters too: no particular person is pushed, so there are no columns for them.
  const ParameterMap map = EveryParameterMap({kMu, kKpTheta});
  for (Posture posture : {Posture::kUpright, Posture::kInitial}) {
    for (double impulse : {25.0, 80.0}) {
      SCOPED_TRACE(impulse);
      ModelOptions options;
      options.posture = posture;
      RestProblem problem = SettlingProblem(SettlingScene(60.0, impulse), options, map, {}, 3.0);
      problem.first_frame = 20, problem.last_frame = 40;
      const SettlingResidual residual(problem);
      ASSERT_EQ(residual.parameter_block_sizes(), (std::vector<int>{kNumParameters}));
      EXPECT_EQ(residual.num_residuals(), 20 * 3);
      const ParameterBlocks blocks = {SharedBlock(map, RandomRecoveringParameters(&random, 0.1))};
      EXPECT_GT(EvaluateCost(residual, blocks, {}).residuals.norm(), 0.1);
      ExpectCorrectJacobian(residual, blocks, {1e-6, 1e-8, 1e-14});
    }
  }
}

// A demand, no pull: exactly zero for whoever settles, and not for one who keeps walking.
TEST(Settling, IsZeroForWhoeverSettlesInTime) {
  ParameterMap map = EveryParameterMap({});
  for (FittedParameter& f : map.fitted) f.transform = Transform::kIdentity;
  for (double mass : {80.0, 100.0}) {
    for (double impulse : {4.0, 25.0}) {
      SCOPED_TRACE(std::to_string(mass) + ", " + std::to_string(impulse));
      const RestProblem problem = SettlingProblem(SettlingScene(mass, impulse), {}, map, {}, 1.0);
      const CostEvaluation settled =
          EvaluateCost(SettlingResidual(problem), {SharedBlock(map, SensibleGains())}, {true});
      ASSERT_TRUE(settled.ok);
      EXPECT_EQ(settled.residuals.norm(), 0.0);
      EXPECT_EQ(settled.jacobians[0].norm(), 0.0);
      ParameterSet<double> self_propelling = SensibleGains();
      self_propelling[kMu] = -20.0;
      const CostEvaluation walking =
          EvaluateCost(SettlingResidual(problem), {SharedBlock(map, self_propelling)}, {});
      ASSERT_TRUE(walking.ok);
      EXPECT_GT(walking.residuals.norm(), 0.1);
    }
  }
}

TEST(Settling, IsZeroForAPersonWhoIsNotPushed) {
  const ParameterMap map = EveryParameterMap({});
  const CostEvaluation evaluation =
      EvaluateCost(SettlingResidual(SettlingProblem(SettlingScene(80.0, 0.0), {}, map, {}, 3)),
                   {SharedBlock(map, SensibleGains())}, {true});
  ASSERT_TRUE(evaluation.ok);
  EXPECT_EQ(evaluation.residuals.norm(), 0.0);
  EXPECT_EQ(evaluation.jacobians[0].norm(), 0.0);
}

// weight^2 is the weight of a mean square, however many frames are looked at.
TEST(Settling, WeightIsThatOfAMeanSquare) {
  const ParameterMap map = EveryParameterMap({});
  const ParameterBlocks blocks = {SharedBlock(map, SensibleGains())};
  RestProblem problem = SettlingProblem(SettlingScene(80.0, 25.0), {}, map, {}, 1.0);
  problem.first_frame = 20, problem.last_frame = 90;  // soon after the push, on the move
  const double cost = Cost(problem, blocks);
  EXPECT_GT(cost, 0.0);
  problem.weight = 3.0;
  EXPECT_NEAR(Cost(problem, blocks), 9.0 * cost, 1e-12 * cost);
  problem.weight = 1.0;
  double sum = 0.0;
  for (int first : {20, 55}) {
    problem.first_frame = first, problem.last_frame = first + 35;
    sum += Cost(problem, blocks);
  }
  EXPECT_NEAR(0.5 * sum, cost, 1e-12 * cost);
}

TEST(Settling, FallingReturnsFalse) {
  ParameterMap map;
  map.values = SensibleGains();
  map.fitted = {{kKpTheta, Transform::kIdentity, -1}};
  const SettlingResidual residual(SettlingProblem(SettlingScene(80.0, 80.0), {}, map, {}, 3.0));
  EXPECT_TRUE(EvaluateCost(residual, {{1560.0}}, {true}).ok);
  EXPECT_FALSE(EvaluateCost(residual, {{0.0}}, {true}).ok);
  EXPECT_FALSE(EvaluateCost(residual, {{0.0}}, {}).ok);
}

TEST(Stability, JacobianAgainstNumericDifferentiation) {
  Random random(52);
  const ParameterMap map = EveryParameterMap({kMu, kKpTheta, kTailTime});
  PendulumRecording recording = PairPushedOnce(120.0, &random);
  recording.initial_velocity = InitialVelocity::kFree;
  for (Posture posture : {Posture::kUpright, Posture::kInitial}) {
    for (double factor : {1.0, 1.4}) {
      SCOPED_TRACE(factor);
      ModelOptions options;
      options.posture = posture;
      const RestProblem problem = StabilityProblem(recording, factor, 40, options, map, {}, 1.0);
      const StabilityResidual residual(problem);
      EXPECT_EQ(residual.num_residuals(), 40 * 2 * 4);
      ASSERT_EQ(residual.parameter_block_sizes(), (std::vector<int>{kNumParameters, 3, 3, 8}));
      ExpectCorrectJacobian(
          residual,
          RandomBlocks(map, problem.layout, RandomRecoveringParameters(&random, 0.1), 0.1, 0.1,
                       &random),
          {1e-6, 1e-8, 1e-14});
    }
  }
}

// In the posture they started from, not upright.
TEST(Stability, IsZeroForPeopleAtRest) {
  Random random(53);
  const PendulumRecording recording = PairPushedOnce(0.0, &random);
  const ParameterMap map = EveryParameterMap({});
  const ParameterBlocks blocks = {SharedBlock(map, SensibleGains())};
  const CostEvaluation evaluation = EvaluateCost(
      StabilityResidual(StabilityProblem(recording, 1.4, 40, {}, map, {}, 1.0)), blocks, {true});
  ASSERT_TRUE(evaluation.ok);
  EXPECT_LT(evaluation.residuals.norm(), 1e-12);
  EXPECT_LT(evaluation.jacobians[0].norm(), 1e-11);
}

// Frames behind the data, of the rollout whose push is multiplied.
TEST(Stability, LooksAtTheFramesBehindTheData) {
  Random random(54);
  const PendulumRecording recording = PairPushedOnce(120.0, &random);
  ParameterMap map;
  map.values = SensibleGains();
  map.fitted = {{kMu, Transform::kLog, -1}};
  const ResidualSigmas sigmas;
  const RestProblem problem = StabilityProblem(recording, 1.4, 10, {}, map, sigmas, 2.0);
  const CostEvaluation evaluation =
      EvaluateCost(StabilityResidual(problem), {{std::log(SensibleGains()[kMu])}}, {});
  ASSERT_TRUE(evaluation.ok);
  const Scene scene = ScalePushes(recording.scene, 1.4);
  RolloutPath<double> path;
  ASSERT_TRUE(
      Rollout(scene, {}, std::vector(2, SensibleGains()), InitialVelocities(scene), 40, &path).ok);
  const Vector4<double>& q0 = scene.people[1].start.q;
  const double w = 2.0 / std::sqrt(10.0 * 2);
  // Person 1 in the last frame: theta, phi, their rates.
  const Vector4<double> last = evaluation.residuals.tail<4>();
  EXPECT_NEAR(last[0], w * (path.At(39, 1).q[2] - q0[2]) / sigmas.angle, 1e-12);
  EXPECT_NEAR(last[1], w * (path.At(39, 1).q[3] - q0[3]) / sigmas.angle, 1e-12);
  EXPECT_NEAR(last[2], w * path.At(39, 1).qd[2] / sigmas.rate, 1e-12);
  EXPECT_NEAR(last[3], w * path.At(39, 1).qd[3] / sigmas.rate, 1e-12);
}

}  // namespace
}  // namespace pushid
