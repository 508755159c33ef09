// Derivatives through lifting off and landing: people who stand, who step and who step again,
// against differences.
#include "residuals/jets/autodiff_rollout.h"
#include "tests/residuals/residual_samples.h"

namespace pushid {
namespace {

constexpr int kStanceFrames = 150;

ModelOptions Steps() {
  ModelOptions options;
  options.stance = Stance::kSteps;
  options.push = PushUse::kAsRecorded;
  return options;
}

ParameterSet<double> SteppingParameters() {
  ParameterSet<double> p = RecoveringParameters();
  p[kKpTheta] = 900.0, p[kKpPhi] = 950.0, p[kKdTheta] = 200.0, p[kKdPhi] = 320.0;
  return p;
}

// Pushed at the hip for half a second, so hard (N s) that people step, forwards or to the side.
Scene PushedAtTheHip(double impulse, double direction, Random* random) {
  Scene scene = SceneOfPeople(1, 0.02, random);
  const Body& body = scene.people[0].body;
  std::vector<Vector4<double>> rows;
  constexpr int kRows = 30;
  for (int t = 0; t < kRows; ++t) {
    const double size =
        impulse * M_PI / (2 * kRows * scene.dt) * std::sin(M_PI * (t + 0.5) / kRows);
    rows.push_back(GeneralizedForce<double>(
        body, scene.people[0].start.q,
        {size * std::cos(direction), size * std::sin(direction), 0.0}, 1.0));
  }
  scene.pushes = {MakeScenePush(0, 0, PushKind::kExternal, rows)};
  return scene;
}

int StepsIn(const PendulumRecording& recording) {
  int steps = 0;
  for (size_t t = 1; t < recording.states[0].size(); ++t) {
    const auto& states = recording.states[0];
    steps += states[t].feet.swings != 0 && states[t - 1].feet.swings == 0;
  }
  return steps;
}

TEST(SteppingRollout, DerivativesEqualDifferencesThroughTheSteps) {
  Random random(77);
  int stepped = 0, stood = 0, twice = 0;
  for (double impulse : {8.0, 25.0, 35.0, 60.0}) {
    for (double direction : {0.0, M_PI, 0.5 * M_PI, -0.7}) {
      SCOPED_TRACE(std::to_string(impulse) + " N s towards " + std::to_string(direction));
      const Scene scene = PushedAtTheHip(impulse, direction, &random);
      const ModelOptions options = Steps();
      PendulumRecording recording =
          RecordRollout(scene, options, {SteppingParameters()}, kStanceFrames);
      const int steps = StepsIn(recording);
      (steps > 0 ? stepped : stood) += 1;
      twice += steps > 1;
      AddNoise(0.01, &random, &recording);
      const ParameterMap map = EveryParameterMap({});
      const auto problem = MakeRolloutProblem(recording, options, map, ResidualSigmas{}, 1.0, 0);
      ExpectDirectionalDerivatives(AutoDiffRollout(problem),
                                   {SharedBlock(map, SteppingParameters())}, {1e-5, 1e-8, 0.0});
    }
  }
  EXPECT_GE(stepped, 6);
  EXPECT_GE(twice, 3);
  EXPECT_GE(stood, 4);
}

// Three in a row who touch: nobody steps, the push is passed on by steps, and who stepped steps
// again.
TEST(SteppingRollout, DerivativesEqualDifferencesThroughTheStepsOfARow) {
  Random random(80);
  ModelOptions options = Steps();
  options.interaction.spring = options.interaction.damping = true;
  ParameterSet<double> p = SteppingParameters();
  p[kContactStiffness] = 4000.0, p[kContactDamping] = 500.0;
  p[kContactDistance] = 0.42, p[kContactKappa] = 0.53, p[kContactHeight] = 0.95;
  int last_steps = 0;
  for (double impulse : {10.0, 60.0, 110.0}) {
    SCOPED_TRACE(impulse);
    PendulumRecording recording =
        RecordRollout(SettlingScene(80.0, impulse, 3), options, {p}, kStanceFrames);
    last_steps = StepsIn(recording);
    EXPECT_EQ(last_steps > 0, impulse > 50.0);
    AddNoise(0.01, &random, &recording);
    const ParameterMap map = EveryParameterMap({});
    const auto problem = MakeRolloutProblem(recording, options, map, ResidualSigmas{}, 1.0, 0);
    ExpectDirectionalDerivatives(AutoDiffRollout(problem), {SharedBlock(map, p)},
                                 {1e-5, 1e-8, 0.0});
  }
  EXPECT_GE(last_steps, 2);
}

// Jets see one sequence of frames; a parameter moves lift-off and landing within them. So the
// derivatives hold for finite changes too, but where a foot begins to step.
TEST(SteppingRollout, AreThoseOfFiniteChanges) {
  Random random(79);
  const Scene scene = PushedAtTheHip(45.0, 0.1, &random);
  const PendulumRecording recording =
      RecordRollout(scene, Steps(), {SteppingParameters()}, kStanceFrames);
  ASSERT_GE(StepsIn(recording), 1);
  const ParameterMap map = EveryParameterMap({});
  const auto problem = MakeRolloutProblem(recording, Steps(), map, ResidualSigmas{}, 1.0, 0);
  const AutoDiffRollout residual(problem);
  const auto at = [&](const std::vector<double>& block, double* jacobian) {
    std::vector<double> r(problem->num_residuals());
    const double* const blocks[] = {block.data()};
    double* jacobians[] = {jacobian};
    EXPECT_TRUE(residual.Evaluate(blocks, r.data(), jacobian != nullptr ? jacobians : nullptr));
    return Eigen::Map<Eigen::VectorXd>(r.data(), static_cast<Eigen::Index>(r.size())).eval();
  };
  const std::vector<double> block = SharedBlock(map, SteppingParameters());
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> jacobian(
      problem->num_residuals(), static_cast<Eigen::Index>(block.size()));
  at(block, jacobian.data());
  for (Parameter id : {kStepOnset, kStepSwing, kStepGain, kSupportFront, kKpTheta}) {
    constexpr double kChange = 0.004;  // of itself: lift-off moves by a tenth of a frame
    const bool log = map.fitted[id].transform == Transform::kLog;
    std::vector<double> more = block, less = block;
    const double step = log ? kChange : kChange * block[id];
    more[id] += step, less[id] -= step;
    const Eigen::VectorXd slope = (at(more, nullptr) - at(less, nullptr)) / (2 * step);
    const Eigen::VectorXd expected = jacobian.col(id);
    EXPECT_LT((slope - expected).norm(), 0.1 * expected.norm()) << map.fitted[id].parameter;
  }
}

// A person whose feet hold, who leans at the start and whose gains differ by direction; and a net
// push, whose rows hold the feet's reaction.
TEST(SteppingRollout, DerivativesEqualDifferencesWhereFeetHold) {
  Random random(78);
  ModelOptions options = Steps();
  options.stance = Stance::kFixed;
  ParameterSet<double> p = SteppingParameters();
  p[kKpPhi] = 1500.0, p[kKdPhi] = 250.0;
  for (PushKind kind : {PushKind::kExternal, PushKind::kNet, PushKind::kNetWithoutFriction}) {
    for (double direction : {0.0, 0.5 * M_PI, -0.7}) {
      Scene scene = PushedAtTheHip(kind == PushKind::kExternal ? 8.0 : 2.0, direction, &random);
      scene.pushes[0].kind = kind;
      PendulumRecording recording = RecordRollout(scene, options, {p}, kStanceFrames);
      AddNoise(0.01, &random, &recording);
      const ParameterMap map = EveryParameterMap({});
      const auto problem = MakeRolloutProblem(recording, options, map, ResidualSigmas{}, 1.0, 0);
      ExpectDirectionalDerivatives(AutoDiffRollout(problem), {SharedBlock(map, p)},
                                   {1e-5, 1e-8, 0.0});
    }
  }
}

}  // namespace
}  // namespace pushid
