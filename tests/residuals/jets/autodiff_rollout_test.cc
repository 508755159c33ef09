// A whole recording's residual: jets against differences for every model, and against Ceres' own
// jets; every width of vectors; failures; horizons.
#include "residuals/jets/autodiff_rollout.h"

#include <ceres/dynamic_autodiff_cost_function.h>

#include "tests/residuals/residual_samples.h"

namespace pushid {
namespace {

constexpr int kRolloutFrames = 40;

// Two people and five pushes of every kind, measured with errors of `noise`.
PendulumRecording PushedPair(const ModelOptions& options, double lean, double push, double noise,
                             Random* random) {
  Scene scene = SceneOfPeople(2, lean, random);
  scene.pushes = {RandomPush(0, 0, 4, PushKind::kNet, push, random),
                  RandomPush(1, 2, 5, PushKind::kNetWithoutFriction, push, random),
                  RandomPush(0, 14, 6, PushKind::kExternal, 0.7 * push, random),
                  RandomPush(1, 20, 3, PushKind::kNet, 0.5 * push, random),
                  RandomPush(0, kRolloutFrames - 3, 9, PushKind::kExternal, push, random)};
  PendulumRecording recording =
      RecordRollout(scene, options, std::vector(2, RecoveringParameters()), kRolloutFrames);
  AddNoise(noise, random, &recording);
  recording.initial_velocity = InitialVelocity::kFree;
  return recording;
}

struct RolloutRegime {
  std::string name;
  double lean, push, velocity, noise;
  double spread;     // of the parameters, relative
  double deviation;  // of a subject, on the fitted scale
  double absolute;   // tolerance where a whole column vanishes
};

std::ostream& operator<<(std::ostream& out, const RolloutRegime& regime) {
  return out << regime.name;
}

class RolloutTwins : public testing::TestWithParam<RolloutRegime> {};

// Every parameter fitted at once, some of them by subject, with free initial velocities.
TEST_P(RolloutTwins, DerivativesEqualDifferencesForEveryModel) {
  const RolloutRegime& regime = GetParam();
  Random random(41);
  const ParameterMap map = EveryParameterMap({kMu, kKpTheta, kKdPhi, kAx, kTailTorque, kTailTime});
  for (const ModelOptions& options : EveryModelOptions()) {
    SCOPED_TRACE(Describe(options));
    const PendulumRecording recording =
        PushedPair(options, regime.lean, regime.push, regime.noise, &random);
    ResidualSigmas sigmas;
    sigmas.robust = random.Unit() < 0.3 ? 0.0 : 1.0;
    const auto problem = MakeRolloutProblem(recording, options, map, sigmas, 0.7, 0);
    const ParameterBlocks blocks =
        RandomBlocks(map, problem->layout, RandomRecoveringParameters(&random, regime.spread),
                     regime.deviation, regime.velocity, &random);
    ASSERT_EQ(blocks.size(), 4u);
    ExpectDirectionalDerivatives(AutoDiffRollout(problem), blocks, {1e-6, regime.absolute, 0.0});
    if (HasFailure()) return;  // one model's report is enough
  }
}

INSTANTIATE_TEST_SUITE_P(
    ThreeRegimes, RolloutTwins,
    testing::Values(RolloutRegime{"at_rest", 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1e-14},
                    RolloutRegime{"tiny", 0.0, 1e-6, 1e-8, 1e-8, 0.3, 0.1, 1e-18},
                    RolloutRegime{"large", 0.1, 150.0, 0.3, 0.05, 0.4, 0.1, 1e-13}),
    [](const auto& test) { return test.param.name; });

// One block of deviations moves both people of one subject.
TEST(PoolingUnits, AreSubjectsSettingsOrConditions) {
  PendulumRecording recording;
  recording.labels.Set(kSettingLabel, "row_1");
  recording.subject_ids = {"a", "b"};
  recording.scene.people.resize(2);
  using Units = std::vector<std::string>;
  EXPECT_EQ(PoolingUnits(recording, kSubjectUnit), (Units{"a", "b"}));
  EXPECT_EQ(PoolingUnits(recording, kSettingLabel), (Units{"row_1", "row_1"}));
  EXPECT_EQ(PoolingUnits(recording, kConditionLabel), (Units{"row_1", "row_1"}));
  recording.labels.Set(kConditionLabel, "p");
  EXPECT_EQ(PoolingUnits(recording, kConditionLabel), (Units{"p", "p"}));
  EXPECT_EQ(PoolingUnits(recording, kSettingLabel), (Units{"row_1", "row_1"}));
}

TEST(RolloutResidual, PeopleMayShareASubject) {
  Random random(42);
  const ParameterMap map = EveryParameterMap({kMu, kKpTheta, kAx});
  PendulumRecording recording = PushedPair({}, 0.1, 150.0, 0.02, &random);
  recording.subject_ids = {"anna", "anna"};
  const auto problem = MakeRolloutProblem(recording, {}, map, {}, 1.0, 0);
  const ParameterBlocks blocks =
      RandomBlocks(map, problem->layout, RecoveringParameters(), 0.1, 0.2, &random);
  ASSERT_EQ(blocks.size(), 3u);
  ExpectDirectionalDerivatives(AutoDiffRollout(problem), blocks);
}

// By every column alone.
TEST(RolloutResidual, JacobianAgainstNumericDifferentiation) {
  Random random(43);
  ModelOptions options;
  options.cart_derivative = CartDerivative::kBackward;
  options.friction = FrictionKind::kAnisotropic;
  const ParameterMap map = EveryParameterMap({kKpTheta, kTailTime});
  const PendulumRecording recording = PushedPair(options, 0.1, 150.0, 0.02, &random);
  const auto problem = MakeRolloutProblem(recording, options, map, {}, 1.0, 0);
  ExpectCorrectJacobian(
      AutoDiffRollout(problem),
      RandomBlocks(map, problem->layout, RecoveringParameters(), 0.1, 0.2, &random),
      {1e-7, 1e-8, 1e-12});
}

// The functor as Ceres' own users take it, and every width of vectors, whose bits are the same.
TEST(RolloutResidual, JetsOfCeresAndOfEveryWidthAgree) {
  Random random(44);
  ModelOptions options;
  options.interaction.spring = options.interaction.damping = true;
  const ParameterMap map = EveryParameterMap({kKpTheta, kTailTime});
  const PendulumRecording recording = PushedPair(options, 0.1, 150.0, 0.02, &random);
  const auto problem = MakeRolloutProblem(recording, options, map, {}, 1.0, 0);
  const ParameterBlocks blocks =
      RandomBlocks(map, problem->layout, RecoveringParameters(), 0.1, 0.2, &random);
  ceres::DynamicAutoDiffCostFunction<RolloutResidual, 16> ceres_own(new RolloutResidual{problem});
  for (int size : problem->layout.BlockSizes()) ceres_own.AddParameterBlock(size);
  ceres_own.SetNumResiduals(problem->num_residuals());
  ExpectCorrectJacobian(AutoDiffRollout(problem), ceres_own, blocks, {1e-10, 1e-13, 1e-12});

  std::vector<const double*> at;
  for (const std::vector<double>& block : blocks) at.push_back(block.data());
  const SensitivityInputs inputs = RolloutInputs(recording.scene, map, problem->layout, at.data());
  std::vector<double> residuals, widest_residuals;
  RowMajorMatrix rows, widest;
  ASSERT_TRUE(RowsByJets(*problem, inputs, &widest_residuals, &widest).ok);
  for (const RolloutJets* jets : SupportedRolloutJets()) {
    ASSERT_TRUE(RowsByJets(*problem, inputs, &residuals, &rows, jets).ok);
    EXPECT_EQ(residuals, widest_residuals) << jets->bits;
    EXPECT_TRUE(rows == widest) << jets->bits;
  }
}

// States without residuals: the path of the plain rollout, and its derivatives by
// the initial velocity at frame 0.
TEST(RolloutResidual, StatesAreThoseOfThePlainRollout) {
  Random random(45);
  for (const ModelOptions& options : EveryModelOptions()) {
    SCOPED_TRACE(Describe(options));
    const PendulumRecording recording = PushedPair(options, 0.1, 150.0, 0.0, &random);
    SensitivityInputs inputs;
    inputs.parameters.assign(2, RecoveringParameters());
    inputs.initial_velocity = InitialVelocities(recording.scene);
    inputs.entries.resize(2);
    inputs.num_columns = 8;
    inputs.velocity_column = 0;
    RolloutPath<double> path;
    StateColumns columns;
    ASSERT_TRUE(
        RolloutWithSensitivities(recording.scene, options, inputs, kRolloutFrames, &path, &columns)
            .ok);
    for (int t = 0; t < kRolloutFrames; ++t) {
      for (int n = 0; n < 2; ++n) {
        // Products of doubles are added up in vectors, in another order.
        const PendulumState<double>& plain = recording.states[n][t];
        ASSERT_LT((path.At(t, n).q - plain.q).norm(), 1e-11) << "frame " << t << ", person " << n;
        ASSERT_LT((path.At(t, n).qd - plain.qd).norm(), 1e-10) << "frame " << t;
      }
    }
    EXPECT_TRUE((columns.At(0, 0).block<4, 4>(4, 0).isIdentity(0.0)));
    EXPECT_TRUE((columns.At(0, 1).block<4, 4>(4, 4).isIdentity(0.0)));
    EXPECT_TRUE(columns.At(0, 0).topRows<4>().isZero(0.0));
  }
}

ParameterBlocks TruthBlocks(const ParameterMap& map) {
  return {SharedBlock(map, RecoveringParameters())};
}

TEST(RolloutResidual, VanishesAtTheTruth) {
  Random random(44);
  PendulumRecording recording = PushedPair({}, 0.1, 150.0, 0.0, &random);
  recording.initial_velocity = InitialVelocity::kZero;
  const ParameterMap map = EveryParameterMap({});
  const auto problem = MakeRolloutProblem(recording, {}, map, {}, 1.0, 0);
  const CostEvaluation at_truth = EvaluateCost(AutoDiffRollout(problem), TruthBlocks(map), {true});
  ASSERT_TRUE(at_truth.ok);
  EXPECT_LT(at_truth.residuals.cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_GT(at_truth.jacobians[0].cwiseAbs().maxCoeff(), 0.1);
}

TEST(RolloutResidual, ShorterHorizonIsTheBeginningOfTheWhole) {
  Random random(45);
  PendulumRecording recording = PushedPair({}, 0.1, 150.0, 0.05, &random);
  recording.initial_velocity = InitialVelocity::kZero;
  const ParameterMap map = EveryParameterMap({});
  const auto evaluate = [&](int horizon, double weight) {
    const auto problem = MakeRolloutProblem(recording, {}, map, {}, weight, horizon);
    return EvaluateCost(AutoDiffRollout(problem), TruthBlocks(map), {true});
  };
  const CostEvaluation whole = evaluate(0, 1.0);
  EXPECT_EQ(whole.residuals.size(), (kRolloutFrames - 1) * 2 * kFrameResiduals);
  for (int horizon : {2, 8, 16, kRolloutFrames}) {
    const CostEvaluation part = evaluate(horizon, 1.0);
    const int rows = (horizon - 1) * 2 * kFrameResiduals;
    ASSERT_EQ(part.residuals.size(), rows);
    EXPECT_EQ(part.residuals, whole.residuals.head(rows));
    EXPECT_EQ(part.jacobians[0], whole.jacobians[0].topRows(rows));
  }
  EXPECT_EQ(evaluate(1000, 1.0).residuals, whole.residuals);
  const CostEvaluation heavy = evaluate(0, 2.0);
  EXPECT_EQ(heavy.residuals, 2.0 * whole.residuals);
  EXPECT_EQ(heavy.jacobians[0], 2.0 * whole.jacobians[0]);
}

struct Failure {
  std::string quantity;
  Parameter parameter;
  double value;
  int person = 1;  // only person 1 is pushed
  int after = 2;   // the push starts at frame 2
};

std::ostream& operator<<(std::ostream& out, const Failure& failure) {
  return out << kParameterNames[failure.parameter] << " = " << failure.value;
}

class FailingRollout : public testing::TestWithParam<Failure> {};

TEST_P(FailingRollout, ReturnsFalseAndNamesWhere) {
  const Failure& failure = GetParam();
  Random random(46);
  Scene scene = SceneOfPeople(2, 0.0, &random);
  Vector4<double> force(0, 0, 0, 0);
  force << 200.0, 0.0, 0.0, 0.0;
  if (failure.quantity == "phi") force << 0.0, 200.0, 0.0, 0.0;
  scene.pushes = {MakeScenePush(1, 2, PushKind::kExternal, {force, force, force})};
  const PendulumRecording recording =
      RecordRollout(scene, {}, std::vector(2, RecoveringParameters()), 150);
  ParameterMap map;
  map.values = RecoveringParameters();
  map.fitted = {{failure.parameter, Transform::kIdentity, -1}};
  const auto problem = MakeRolloutProblem(recording, {}, map, {}, 1.0, 0);
  const AutoDiffRollout residual(problem);
  for (const std::vector<bool>& wanted : {std::vector<bool>{}, std::vector<bool>{true}}) {
    EXPECT_TRUE(EvaluateCost(residual, {{map.values[failure.parameter]}}, wanted).ok);
    EXPECT_FALSE(EvaluateCost(residual, {{failure.value}}, wanted).ok);
  }
  const double* const blocks[] = {&failure.value};
  std::vector<double> residuals(problem->num_residuals());
  const RolloutStatus status = RolloutResidual::At(*problem, blocks, residuals.data());
  EXPECT_FALSE(status.ok);
  EXPECT_EQ(status.person, failure.person);
  EXPECT_EQ(status.quantity, failure.quantity);
  EXPECT_GT(status.frame, failure.after);
  EXPECT_LT(status.frame, 150);
}

// An overflow leaves the domain while it is finite; a NaN spoils the first person at once.
INSTANTIATE_TEST_SUITE_P(EveryQuantity, FailingRollout,
                         testing::Values(Failure{"theta", kKpTheta, -3000.0},
                                         Failure{"phi", kKpPhi, -3000.0},
                                         Failure{"theta", kMu, 1e308},
                                         Failure{"state", kMu, std::nan(""), 0, 0}));

// Whatever stands in frames of weight 0 does not matter, and the others are as before.
TEST(RolloutResidual, FramesThatWereNotSeenDoNotCount) {
  Random random(47);
  const ParameterMap map = EveryParameterMap({});
  const ModelOptions options = EveryModelOptions().front();
  PendulumRecording recording = PushedPair(options, 0.05, 60.0, 0.01, &random);
  const auto evaluate = [&](const PendulumRecording& one) {
    const auto problem = MakeRolloutProblem(one, options, map, ResidualSigmas{}, 1.0, 0);
    Random again(48);
    const ParameterBlocks blocks =
        RandomBlocks(map, problem->layout, RecoveringParameters(), 0.0, 0.0, &again);
    std::vector<const double*> pointers;
    for (const auto& block : blocks) pointers.push_back(block.data());
    std::vector<double> residuals(problem->num_residuals(), std::nan(""));
    EXPECT_TRUE(AutoDiffRollout(problem).Evaluate(pointers.data(), residuals.data(), nullptr));
    return residuals;
  };
  const std::vector<double> full = evaluate(recording);
  recording.weight = {std::vector<double>(kRolloutFrames, 1.0), {}};
  for (int t = 10; t < 15; ++t) {
    recording.weight[0][t] = 0.0;
    recording.hip[0][t].setConstant(7.0);
    recording.states[0][t].q.setConstant(-1.0);
  }
  const std::vector<double> gap = evaluate(recording);
  ASSERT_EQ(gap.size(), full.size());
  for (std::size_t i = 0; i < gap.size(); ++i) {
    const int row = static_cast<int>(i) / kFrameResiduals, frame = 1 + row / 2;
    const bool hidden = row % 2 == 0 && frame >= 10 && frame < 15;
    EXPECT_EQ(gap[i], hidden ? 0.0 : full[i]) << frame;
  }
}

}  // namespace
}  // namespace pushid
