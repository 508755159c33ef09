// Derivatives through the latched step state: people who stand, let go, step and stand again,
// against Jets of the same rollout.
#include "residuals/sensitivities/stance_sensitivities.h"

#include "tests/residuals/residual_samples.h"
#include "tests/residuals/rollout_residual.h"

namespace pushid {
namespace {

constexpr int kStanceFrames = 150;

ModelOptions Threshold() {
  ModelOptions options;
  options.stance = Stance::kThreshold;
  options.push = PushUse::kAsRecorded;
  options.friction = FrictionKind::kAnisotropic;
  return options;
}

ParameterSet<double> SteppingParameters() {
  ParameterSet<double> p = RecoveringParameters();
  p[kMu] = p[kMuY] = 90.0, p[kAx] = p[kAy] = 16.0, p[kBx] = p[kBy] = 0.2;
  p[kKpTheta] = p[kKpPhi] = 1150.0, p[kKdTheta] = p[kKdPhi] = 330.0;
  p[kStepRelease] = 0.25;
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

TEST(StanceSensitivities, EqualJetsThroughTheSwitch) {
  Random random(77);
  int stepped = 0, stood = 0;
  for (double impulse : {8.0, 25.0, 35.0, 60.0}) {
    for (double direction : {0.0, M_PI, 0.5 * M_PI, -0.7}) {
      const Scene scene = PushedAtTheHip(impulse, direction, &random);
      const ModelOptions options = Threshold();
      PendulumRecording recording =
          RecordRollout(scene, options, {SteppingParameters()}, kStanceFrames);
      double most = 0.0;
      for (const PendulumState<double>& state : recording.states[0]) {
        most = std::max(most, state.step);
      }
      (most > 0.9 ? stepped : stood) += 1;
      if (most > 0.9) {
        EXPECT_LT(recording.states[0].back().step, 0.5);
      }
      AddNoise(0.01, &random, &recording);
      const ParameterMap map = EveryParameterMap({});
      const auto problem = MakeRolloutProblem(recording, options, map, ResidualSigmas{}, 1.0, 0);
      ExpectCorrectJacobian(RolloutResidual(problem), *RolloutByJets(problem),
                            {SharedBlock(map, SteppingParameters())}, {1e-9, 1e-12, 1e-12});
    }
  }
  EXPECT_GE(stepped, 6);
  EXPECT_GE(stood, 4);
}

// Who holds, leans at the start and has gains that differ by direction; and a net push, whose rows
// hold the feet's reaction.
TEST(StanceSensitivities, EqualJetsWhereFeetHold) {
  Random random(78);
  ModelOptions options = Threshold();
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
      ExpectCorrectJacobian(RolloutResidual(problem), *RolloutByJets(problem),
                            {SharedBlock(map, p)}, {1e-8, 1e-10, 1e-10});
    }
  }
}

// Across the place where the support changes from b to b_back, and at rest.
TEST(StanceSensitivities, AreFiniteAtTheEdges) {
  const ModelOptions options = Threshold();
  const Body body{80.0, 0.95, 0.1};
  Scene scene;
  scene.people.push_back({body, {}});
  const SelfForce self(options, body, Vector4<double>::Zero(), scene.dt);
  for (double lean : {0.0, 1e-300, 1e-9, -1e-9, 0.1, -0.1}) {
    for (double step : {0.0, 1.0}) {
      PendulumState<double> state;
      state.q[2] = lean;
      state.step = step;
      SelfForce::Jacobian jacobian;
      StanceJacobian stance;
      NetForceJacobianOfStance(scene, options, self, SteppingParameters(), 0, 0, state,
                               Vector4<double>::Zero(), &jacobian, &stance);
      EXPECT_TRUE(jacobian.by_state.allFinite() && jacobian.by_parameter.allFinite());
      EXPECT_TRUE(stance.by_step.allFinite() && stance.next_by_state.allFinite());
      EXPECT_TRUE(stance.next_by_parameter.allFinite() && std::isfinite(stance.next_by_step));
    }
  }
}

}  // namespace
}  // namespace pushid
