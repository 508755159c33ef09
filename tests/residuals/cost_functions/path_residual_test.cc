// Most probable paths: the action of people.
#include <ceres/dynamic_autodiff_cost_function.h>

#include "residuals/cost_functions/likelihood_residual.h"
#include "tests/residuals/residual_samples.h"

namespace pushid {
namespace {

ParameterSet<double> Noisy() {
  ParameterSet<double> p = RecoveringParameters();
  p[kSigmaX] = 20.0, p[kSigmaY] = 15.0, p[kSigmaTheta] = 12.0, p[kSigmaPhi] = 9.0;
  return p;
}

// Two people who touch, one of them pushed, at three frames about one of a rollout.
struct ThreeFrames {
  Scene scene;
  ModelOptions options;
  std::vector<ParameterSet<double>> parameters = {Noisy(), Noisy()};
  ParameterBlocks nodes = ParameterBlocks(3, std::vector<double>(8));

  explicit ThreeFrames(double noise) {
    Random random(4);
    scene = SceneOfPeople(2, 0.03, &random);
    scene.people[1].start.q[0] = 0.45;
    scene.pushes = {RandomPush(0, 3, 10, PushKind::kExternal, 90.0, &random)};
    options.interaction.spring = options.interaction.damping = true;
    options.process_noise = ProcessNoise::kDiagonal;
    const PendulumRecording recording = RecordRollout(scene, options, parameters, 12);
    for (int i = 0; i < 3; ++i) {
      for (int n = 0; n < 2; ++n) {
        for (int k = 0; k < 4; ++k) {
          nodes[i][4 * n + k] = recording.states[n][5 + i].q[k] + random.Normal(0.0, noise);
        }
      }
    }
  }
};

TEST(SceneAction, ItsJacobianIsThatOfNumericDifferentiation) {
  for (double noise : {0.0, 1e-5, 1e-3}) {
    ThreeFrames frames(noise);
    ceres::DynamicAutoDiffCostFunction<SceneAction, 12> cost(
        new SceneAction{&frames.scene, &frames.options, &frames.parameters, 6});
    for (int i = 0; i < 3; ++i) cost.AddParameterBlock(8);
    cost.SetNumResiduals(10);
    ExpectCorrectJacobian(cost, frames.nodes, {1e-6, 1e-6, 1e-13});
  }
}

// By each person's own velocity, from differences of the forces themselves: friction and damping
// make it negative.
TEST(SceneAction, ItsDivergenceRowIsHalfTheDivergence) {
  const ThreeFrames frames(0.0);
  const double* const at[] = {frames.nodes[0].data(), frames.nodes[1].data(),
                              frames.nodes[2].data()};
  std::vector<double> rows(10);
  ASSERT_TRUE(
      (SceneAction{&frames.scene, &frames.options, &frames.parameters, 6}(at, rows.data())));
  const std::vector<PendulumState<double>> states = StatesAtNode(at, 2, frames.scene.dt);
  ModelStep<double> forces(frames.scene, frames.options, frames.parameters);
  std::vector<int> scratch;
  constexpr double kStep = 1e-5;
  for (int n = 0; n < 2; ++n) {
    double divergence = 0.0;
    for (int i = 0; i < 4; ++i) {
      for (double sign : {1.0, -1.0}) {
        std::vector<PendulumState<double>> moved = states;
        moved[n].qd[i] += sign * kStep;
        forces.Update(moved.data());
        forces.Prepare(n, &scratch);
        const NetForce<double> force = forces.On(n, 6, moved[n].qd);
        divergence += sign * forces.AccelerationOf(n, force)[i] / (2.0 * kStep);
      }
    }
    EXPECT_LT(divergence, -0.1);
    const double row = rows[SceneAction::kRows * n + 4];
    EXPECT_NEAR(0.5 * row * row - kDivergenceShift, 0.5 * frames.scene.dt * divergence, 1e-7);
  }
}

// A rollout needs little noise; a motion against the forces needs much.
TEST(SceneAction, RolloutsAreProbable) {
  const ThreeFrames frames(0.0);
  ThreeFrames against(0.0);
  against.nodes[2][0] += 0.01;  // 36 m/s^2
  std::vector<double> rows(10), moved(10);
  const SceneAction action{&frames.scene, &frames.options, &frames.parameters, 6};
  const double* const at[] = {frames.nodes[0].data(), frames.nodes[1].data(),
                              frames.nodes[2].data()};
  const double* const other[] = {against.nodes[0].data(), against.nodes[1].data(),
                                 against.nodes[2].data()};
  ASSERT_TRUE(action(at, rows.data()));
  ASSERT_TRUE(action(other, moved.data()));
  const auto noise = [](const std::vector<double>& r) {
    return r[0] * r[0] + r[1] * r[1] + r[2] * r[2] + r[3] * r[3];
  };
  EXPECT_LT(noise(rows), 0.02);
  EXPECT_GT(noise(moved), 50.0);
}

}  // namespace
}  // namespace pushid
