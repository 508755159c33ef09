// Equation error: forces against inverse dynamics at smoothed states.
#include "residuals/cost_functions/equation_error_residual.h"

#include <Eigen/Core>

#include "models/decompositions.h"
#include "tests/residuals/residual_samples.h"

namespace pushid {
namespace {

constexpr double kFps = 60.0;
constexpr int kCubicFrames = 40;

// Two people whose coordinates are cubics in time, which the smoothing reproduces exactly, and the
// pushes that make the model move them so: the truth leaves no error at all.
PendulumRecording CubicMotion(const ModelOptions& options, const ParameterSet<double>& truth,
                              Random* random) {
  PendulumRecording recording;
  recording.scene = SceneOfPeople(2, 0.1, random);
  recording.scene.dt = 1.0 / kFps;
  std::vector<Eigen::Matrix4d> coefficients(2);  // power of time x component
  for (int n = 0; n < 2; ++n) {
    Eigen::Matrix4d& c = coefficients[n];
    c = Eigen::Matrix4d::NullaryExpr([&](auto, auto) { return random->Uniform(-0.3, 0.3); });
    c.row(0) = recording.scene.people[n].start.q.transpose();
    recording.subject_ids.push_back("S" + std::to_string(n));
    recording.states.emplace_back(kCubicFrames);
    recording.hip.emplace_back(kCubicFrames);
    const SelfForce self(options, recording.scene.people[n].body, c.row(0).transpose(), 1.0 / kFps);
    std::vector<Vector4<double>> force;
    for (int t = 0; t < kCubicFrames; ++t) {
      const auto state_at = [&](double s) {
        return PendulumState<double>{c.transpose() * Vector4<double>(1, s, s * s, s * s * s),
                                     c.transpose() * Vector4<double>(0, 1, 2 * s, 3 * s * s)};
      };
      const double s = t / kFps, before = std::max(0, t - 1) / kFps;
      const Vector4<double> qdd = c.transpose() * Vector4<double>(0, 0, 2, 6 * s);
      const PendulumState<double> state = state_at(s);
      recording.states[n][t] = state;
      force.push_back(InverseDynamics(recording.scene.people[n].body, state, qdd) -
                      self.Total(truth, state, state_at(before).qd));
    }
    recording.scene.pushes.push_back(MakeScenePush(n, 0, PushKind::kExternal, force));
  }
  return recording;
}

TEST(EquationError, VanishesAtTheTruthOfAMotionTheSmoothingReproduces) {
  Random random(61);
  const ParameterMap map = EveryParameterMap({});
  for (const ModelOptions& options : EveryModelOptions()) {
    if (options.stance != Stance::kSlide) continue;  // equation error knows no step state
    SCOPED_TRACE(Describe(options));
    const PendulumRecording recording = CubicMotion(options, RecoveringParameters(), &random);
    const CostEvaluation evaluation = EvaluateCost(EquationErrorResidual(recording, options, map),
                                                   {SharedBlock(map, RecoveringParameters())}, {});
    ASSERT_TRUE(evaluation.ok);
    ASSERT_EQ(evaluation.residuals.size(), 4 * 2 * kCubicFrames);
    EXPECT_LT(evaluation.residuals.cwiseAbs().maxCoeff(), 1e-8);  // m/s^2
  }
}

TEST(EquationError, VanishesForPeopleAtRest) {
  Random random(62);
  const Scene scene = SceneOfPeople(2, 0.1, &random);
  const PendulumRecording recording =
      RecordRollout(scene, {}, std::vector(2, RecoveringParameters()), 30);
  const ParameterMap map = EveryParameterMap({});
  const CostEvaluation evaluation = EvaluateCost(EquationErrorResidual(recording, {}, map),
                                                 {SharedBlock(map, RecoveringParameters())}, {});
  EXPECT_LT(evaluation.residuals.cwiseAbs().maxCoeff(), 1e-9);
}

// A rolled-out motion leaves an error of order dt: semi-implicit Euler's velocity is the backward
// difference, half a step behind the smoothed one. It shrinks with dt as it should.
TEST(EquationError, OfARolledOutMotionShrinksWithTheStep) {
  Random random(63);
  Scene scene = SceneOfPeople(1, 0.05, &random);
  const ParameterMap map = EveryParameterMap({});
  std::vector<double> errors;
  for (int refinement : {1, 4, 16}) {
    scene.dt = 1.0 / (kFps * refinement);
    scene.pushes = {
        MakeScenePush(0, 0, PushKind::kExternal,
                      HalfSinePush(scene.people[0].body, 25.0, 30 * refinement, scene.dt))};
    const PendulumRecording recording =
        RecordRollout(scene, {}, {RecoveringParameters()}, kCubicFrames * refinement);
    const CostEvaluation evaluation = EvaluateCost(EquationErrorResidual(recording, {}, map, 5),
                                                   {SharedBlock(map, RecoveringParameters())}, {});
    errors.push_back(evaluation.residuals.norm() /
                     std::sqrt(static_cast<double>(evaluation.residuals.size())));
  }
  EXPECT_LT(errors[0], 0.15);  // m/s^2, root mean square at 60 Hz
  EXPECT_LT(errors[1], errors[0] / 3.0);
  EXPECT_LT(errors[2], errors[1] / 3.0);
}

TEST(EquationError, JacobianAgainstNumericDifferentiation) {
  Random random(64);
  const ParameterMap map = EveryParameterMap({kMu, kKpTheta, kTailTime});
  for (const ModelOptions& options : EveryModelOptions()) {
    if (options.stance != Stance::kSlide) continue;  // equation error knows no step state
    SCOPED_TRACE(Describe(options));
    Scene scene = SceneOfPeople(2, 0.1, &random);
    scene.pushes = {RandomPush(0, 0, 4, PushKind::kNet, 120.0, &random),
                    RandomPush(1, 3, 5, PushKind::kNetWithoutFriction, 120.0, &random),
                    RandomPush(0, 9, 5, PushKind::kExternal, 80.0, &random)};
    PendulumRecording recording =
        RecordRollout(scene, options, std::vector(2, RecoveringParameters()), 20);
    AddNoise(1e-3, &random, &recording);
    recording.initial_velocity = InitialVelocity::kFree;
    const EquationErrorResidual residual(recording, options, map);
    const BlockLayout layout(map, recording.subject_ids, true);
    ExpectCorrectJacobian(
        residual,
        RandomBlocks(map, layout, RandomRecoveringParameters(&random, 0.3), 0.1, 0.1, &random),
        {1e-7, 1e-7, 1e-12});
    if (HasFailure()) return;
  }
}

// Linear in every gain: one linear solve from nowhere finds the truth, which is why it starts a
// fit. mu is held, since it moves the same velocity as Kp_x.
TEST(EquationError, OneLinearSolveFindsTheGains) {
  Random random(65);
  ModelOptions options;
  options.friction = FrictionKind::kAnisotropic;
  const ParameterSet<double> truth = RecoveringParameters();
  const PendulumRecording recording = CubicMotion(options, truth, &random);
  ParameterMap map;
  map.values = truth;
  std::vector<double> start;
  for (Parameter p :
       {kKpX, kKpY, kKpTheta, kKpPhi, kKdTheta, kKdPhi, kAx, kAy, kBx, kBy, kTx, kTy, kCq, kDq}) {
    map.fitted.push_back({p, Transform::kIdentity, -1});
    start.push_back(0.0);
  }
  const CostEvaluation at_start =
      EvaluateCost(EquationErrorResidual(recording, options, map), {start}, {true});
  const Eigen::MatrixXd jacobian = at_start.jacobians[0];
  const Eigen::VectorXd found = SolveLeastNorm(jacobian, Eigen::VectorXd(-at_start.residuals));
  for (size_t i = 0; i < map.fitted.size(); ++i) {
    const Parameter p = map.fitted[i].parameter;
    EXPECT_NEAR(found[i], truth[p], 1e-6 * std::max(1.0, std::abs(truth[p]))) << kParameterNames[p];
  }
}

}  // namespace
}  // namespace pushid
