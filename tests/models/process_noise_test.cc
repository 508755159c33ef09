// Process noise: its factor, and what it does to a rollout.
#include "models/process_noise.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "models/rollout.h"
#include "tests/models/model_samples.h"

namespace pushid {
namespace {

Scene OnePerson() {
  Scene scene;
  ScenePerson person;
  person.body = {72.0, 0.9, 0.05};
  person.start.q = {0.1, -0.2, 0.05, -0.03};
  person.start.qd = {0.4, -0.3, 0.2, 0.1};
  scene.people.push_back(person);
  scene.pushes.push_back(MakeScenePush(0, 2, PushKind::kExternal,
                                       std::vector<Vector4<double>>(3, Vector4<double>::Ones())));
  return scene;
}

ParameterSet<double> Noisy() {
  ParameterSet<double> p{};
  p[kSigmaX] = 20.0, p[kSigmaY] = 12.0, p[kSigmaTheta] = 9.0, p[kSigmaPhi] = 7.0;
  return p;
}

TEST(NoiseFactor, IsDiagonalAndScalesWithMass) {
  const double mass = 72.0 / kReferenceMass;
  ExpectClose(NoiseFactor<double>(OnePerson().people[0].body, Noisy()),
              Matrix4<double>((mass * Vector4<double>(20.0, 12.0, 9.0, 7.0)).asDiagonal()), 1e-12);
}

// Cov(qd') = dt M^-1 L L' M^-1 about the step without noise.
TEST(ProcessNoise, AStepScattersAsItsFactorSays) {
  const Scene scene = OnePerson();
  ModelOptions options;
  options.process_noise = ProcessNoise::kDiagonal;
  const std::vector<ParameterSet<double>> p = {Noisy()};
  RolloutPath<double> plain, driven;
  ASSERT_TRUE(Rollout<double>(scene, options, p, InitialVelocities(scene), 2, &plain).ok);
  Random random(5);
  constexpr int kDraws = 40000;
  Matrix4<double> found = Matrix4<double>::Zero();
  Vector4<double> mean = Vector4<double>::Zero();
  for (int i = 0; i < kDraws; ++i) {
    FrameTable<Vector4<double>> noise(2, 1);
    for (double& w : noise.At(0, 0)) w = random.Normal();
    ASSERT_TRUE(Rollout<double>(scene, options, p, InitialVelocities(scene), 2, &driven, nullptr,
                                nullptr, &noise)
                    .ok);
    const Vector4<double> apart = driven.At(1, 0).qd - plain.At(1, 0).qd;
    mean += apart / kDraws;
    found += apart * apart.transpose() / kDraws;
  }
  const Body& body = scene.people[0].body;
  const Vector4<double>& q = scene.people[0].start.q;
  const Matrix4<double> gain =
      MassMatrix<double>(body, q).inverse() * NoiseFactor<double>(body, p[0]);
  const Matrix4<double> expected = scene.dt * gain * gain.transpose();
  const double size = expected.diagonal().maxCoeff();
  ExpectClose(found, expected, 4.0 * std::sqrt(2.0 / kDraws), size);
  EXPECT_LT(mean.cwiseAbs().maxCoeff(), 5.0 * std::sqrt(size / kDraws));
}

TEST(ProcessNoise, DrawsOfZeroChangeNothing) {
  const Scene scene = OnePerson();
  ModelOptions options;
  options.process_noise = ProcessNoise::kDiagonal;
  ParameterSet<double> p = Noisy();
  p[kMu] = 40.0, p[kKpTheta] = p[kKpPhi] = 1500.0, p[kTailTime] = 0.2;
  RolloutPath<double> plain, driven;
  const FrameTable<Vector4<double>> zeros(30, 1);
  FrameTable<Vector4<double>> none = zeros;
  for (int t = 0; t < 30; ++t) none.At(t, 0).setZero();
  ASSERT_TRUE(Rollout<double>(scene, options, {p}, InitialVelocities(scene), 30, &plain).ok);
  ASSERT_TRUE(Rollout<double>(scene, options, {p}, InitialVelocities(scene), 30, &driven, nullptr,
                              nullptr, &none)
                  .ok);
  for (int t = 0; t < 30; ++t) EXPECT_EQ(plain.At(t, 0).q, driven.At(t, 0).q) << t;
}

}  // namespace
}  // namespace pushid
