// Settling: a person who was pushed settles.
#include "residuals/cost_functions/rest_residual.h"

#include "models/force_law.h"
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

double Cost(const SettlingProblem& problem, const ParameterBlocks& blocks) {
  const CostEvaluation evaluation = EvaluateCost(SettlingResidual(problem), blocks, {});
  EXPECT_TRUE(evaluation.ok);
  return 0.5 * evaluation.residuals.squaredNorm();
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
      SettlingProblem problem =
          MakeSettlingProblem({SettlingScene(60.0, impulse)}, options, map, 3.0);
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

// Does nothing, but has no lanes (HasLanes).
struct NoForce : ForceLaw {
  NoForce() : ForceLaw("none", {}) {}
  Vector4<double> Force(const LawPerson&, const Inputs&, Jacobian* jacobian) const override {
    if (jacobian != nullptr) jacobian->setZero();
    return Vector4<double>::Zero();
  }
};

// Where everybody is on the move, some have settled, and all.
TEST(Settling, SimulationsSideBySideAreThoseOfEach) {
  const ParameterMap map = EveryParameterMap({});
  const std::vector<Scene> scenes = {SettlingScene(60.0, 15.0), SettlingScene(60.0, 25.0),
                                     SettlingScene(60.0, 80.0)};
  const ParameterBlocks blocks = {SharedBlock(map, SensibleGains())};
  ModelOptions alone;
  alone.own_laws = {std::make_shared<NoForce>()};
  ASSERT_TRUE(HasLanes(scenes[0], {}));
  ASSERT_FALSE(HasLanes(scenes[0], alone));
  for (int first : {20, 70, 400}) {
    SCOPED_TRACE(first);
    SettlingProblem problem = MakeSettlingProblem(scenes, {}, map, 3.0);
    problem.first_frame = first, problem.last_frame = first + 60;
    const SettlingResidual in_lanes(problem);
    problem.options = alone;
    ExpectCorrectJacobian(in_lanes, SettlingResidual(problem), blocks, {1e-10, 1e-13, 1e-12});
    const Eigen::VectorXd rows = EvaluateCost(in_lanes, blocks, {}).residuals;
    ASSERT_EQ(rows.size(), 3 * 60 * 3);
    EXPECT_EQ(rows.head(180).norm() > 0.0, first == 20);
    EXPECT_EQ(rows.tail(180).norm() > 0.0, first != 400);
  }
}

// A demand, no pull: exactly zero for people who settle, and not for one who keeps walking.
TEST(Settling, IsZeroForPeopleWhoSettleInTime) {
  ParameterMap map = EveryParameterMap({});
  for (FittedParameter& f : map.fitted) f.transform = Transform::kIdentity;
  for (double mass : {80.0, 100.0}) {
    for (double impulse : {4.0, 25.0}) {
      SCOPED_TRACE(std::to_string(mass) + ", " + std::to_string(impulse));
      const SettlingProblem problem =
          MakeSettlingProblem({SettlingScene(mass, impulse)}, {}, map, 1.0);
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
      EvaluateCost(SettlingResidual(MakeSettlingProblem({SettlingScene(80.0, 0.0)}, {}, map, 3)),
                   {SharedBlock(map, SensibleGains())}, {true});
  ASSERT_TRUE(evaluation.ok);
  EXPECT_EQ(evaluation.residuals.norm(), 0.0);
  EXPECT_EQ(evaluation.jacobians[0].norm(), 0.0);
}

// weight^2 is the weight of a mean square, however many frames are looked at.
TEST(Settling, WeightIsThatOfAMeanSquare) {
  const ParameterMap map = EveryParameterMap({});
  const ParameterBlocks blocks = {SharedBlock(map, SensibleGains())};
  SettlingProblem problem = MakeSettlingProblem({SettlingScene(80.0, 25.0)}, {}, map, 1.0);
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

// Simulations are kept for derivatives at the same point, and for no other.
TEST(Settling, ValuesAreThoseOfThePointWhateverWasAskedBefore) {
  const ParameterMap map = EveryParameterMap({});
  ModelOptions alone;
  alone.own_laws = {std::make_shared<NoForce>()};
  for (const ModelOptions& options : {ModelOptions(), alone}) {
    SettlingProblem problem = MakeSettlingProblem({SettlingScene(80.0, 80.0)}, options, map, 3.0);
    problem.first_frame = 20, problem.last_frame = 90;
    const SettlingResidual asked(problem);
    std::vector<double> here = SharedBlock(map, SensibleGains()), there = here;
    there[kKpTheta] += 0.1;
    const std::vector<std::pair<std::vector<double>, std::vector<bool>>> questions = {
        {here, {}}, {here, {true}}, {here, {}}, {there, {true}}, {there, {true}}, {here, {true}}};
    for (const auto& [at, derivatives] : questions) {
      const CostEvaluation got = EvaluateCost(asked, {at}, derivatives);
      const CostEvaluation fresh = EvaluateCost(SettlingResidual(problem), {at}, derivatives);
      ASSERT_TRUE(got.ok);
      EXPECT_GT(fresh.residuals.norm(), 0.0);
      EXPECT_EQ(got.residuals, fresh.residuals);
      if (!derivatives.empty()) {
        EXPECT_EQ(got.jacobians[0], fresh.jacobians[0]);
      }
    }
  }
}

TEST(Settling, FallingReturnsFalse) {
  ParameterMap map;
  map.values = SensibleGains();
  map.fitted = {{kKpTheta, Transform::kIdentity, -1}};
  const SettlingResidual residual(
      MakeSettlingProblem({SettlingScene(80.0, 0.0), SettlingScene(80.0, 80.0)}, {}, map, 3.0));
  EXPECT_TRUE(EvaluateCost(residual, {{1560.0}}, {true}).ok);
  EXPECT_FALSE(EvaluateCost(residual, {{0.0}}, {true}).ok);
  EXPECT_FALSE(EvaluateCost(residual, {{0.0}}, {}).ok);
}

}  // namespace
}  // namespace pushid
