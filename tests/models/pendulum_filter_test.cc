// The extended Kalman filter against the dense Gaussian that it factors, and on motions with known
// noise.
#include "models/pendulum_filter.h"

#include <gtest/gtest.h>

#include <Eigen/Core>

#include "models/decompositions.h"
#include "tests/models/model_samples.h"

namespace pushid {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

ParameterSet<double> Standing() {
  ParameterSet<double> p{};
  p[kMu] = 40.0, p[kKpTheta] = p[kKpPhi] = 1600.0, p[kKdTheta] = p[kKdPhi] = 90.0;
  p[kAx] = p[kAy] = -8.0;
  p[kTailTime] = 0.2;
  p[kContactStiffness] = 2000.0, p[kContactDistance] = 0.9, p[kContactKappa] = 0.6;
  p[kContactDamping] = 100.0, p[kContactHeight] = 0.5;
  p[kSigmaX] = 3.0, p[kSigmaY] = 2.0, p[kSigmaTheta] = 1.5, p[kSigmaPhi] = 1.0;
  p[kMeasuredCart] = 0.002, p[kMeasuredHip] = 0.001;
  return p;
}

Scene People(int count) {
  Scene scene;
  for (int n = 0; n < count; ++n) {
    ScenePerson person;
    person.body = {75.0 + 5.0 * n, 0.92, 0.0};
    person.start.q = {0.45 * n, 0.0, 0.02, -0.01};
    scene.people.push_back(person);
  }
  scene.pushes.push_back(MakeScenePush(0, 0, PushKind::kExternal,
                                       std::vector<Vector4<double>>(6, {40.0, 8.0, 20.0, -5.0})));
  return scene;
}

// E with E E' = their covariance.
Matrix4<double> MeasurementError(const Body& body, const ParameterSet<double>& p) {
  return CholeskyFactor<double, 4>(MeasurementCovariance(body, p));
}

// The measurements as a function of everything random: velocities at the start, places, draws of
// the process.
struct Experiment {
  Scene scene;
  ModelOptions options;
  ParameterSet<double> p{};
  int frames;

  int num_inputs() const { return 8 + 4 * (frames - 1); }
  VectorXd Places(const VectorXd& z) const {
    Scene moved = scene;
    moved.people[0].start.q += MeasurementError(scene.people[0].body, p) * z.head<4>();
    std::vector<Vector4<double>> rates = {scene.people[0].start.qd + kStartRate * z.segment<4>(4)};
    FrameTable<Vector4<double>> noise(frames, 1);
    for (int t = 0; t + 1 < frames; ++t) noise.At(t, 0) = z.segment<4>(8 + 4 * t);
    // The posture, and the torque that holds it, stay those of frame 0 as measured.
    RolloutPath<double> path(frames, 1);
    path.At(0, 0) = {moved.people[0].start.q, rates[0]};
    ModelStep<double> forces(scene, options, parameters);
    std::vector<int> scratch;
    VectorXd places(4 * (frames - 1));
    for (int t = 0; t + 1 < frames; ++t) {
      forces.Update(path.Frame(t));
      forces.Prepare(0, &scratch);
      NetForce<double> force = forces.On(0, t, path.At(t, 0).qd);
      force[ForcePart::kNoise] =
          NoiseFactor<double>(scene.people[0].body, p) * noise.At(t, 0) / std::sqrt(scene.dt);
      path.At(t + 1, 0) = forces.Next(0, forces.AccelerationOf(0, force), force, path.At(t, 0).qd);
      places.segment<4>(4 * t) = path.At(t + 1, 0).q;
    }
    return places;
  }
  std::vector<ParameterSet<double>> parameters = {p};
};

// The filter's densities of one person multiply to that of all measurements at once, as far as the
// motion is linear.
TEST(PendulumFilter, ItsDensitiesMultiplyToTheDenseGaussian) {
  Experiment e;
  e.scene = People(1);
  e.options.process_noise = ProcessNoise::kDiagonal;
  e.p = Standing();
  e.frames = 25;
  e.parameters = {e.p};
  const VectorXd zero = VectorXd::Zero(e.num_inputs());
  const VectorXd mean = e.Places(zero);
  MatrixXd root(mean.size(), zero.size());
  for (Eigen::Index i = 0; i < zero.size(); ++i) {
    VectorXd above = zero, below = zero;
    above[i] = 1e-3, below[i] = -1e-3;
    root.col(i) = (e.Places(above) - e.Places(below)) / 2e-3;
  }
  MatrixXd covariance = root * root.transpose();
  for (Eigen::Index i = 0; i < mean.size(); i += 4) {
    covariance.block<4, 4>(i, i) += MeasurementCovariance(e.scene.people[0].body, e.p);
  }

  Random random(8);
  const MatrixXd factor = CholeskyFactor(covariance);
  VectorXd white(mean.size());
  for (double& w : white) w = random.Normal();
  const VectorXd apart = factor * white, measured = mean + apart;
  const double dense = white.squaredNorm() + 2.0 * factor.diagonal().array().log().sum();

  PendulumFilter filter(e.scene, e.options, e.parameters);
  double factored = 0.0;
  for (int t = 0; t + 1 < e.frames; ++t) {
    ASSERT_TRUE(filter.Predict(t).ok);
    const auto innovation = filter.Update(0, measured.segment<4>(4 * t), 1.0);
    factored += SolveLower<double, 4, 1>(innovation.lower, innovation.v).squaredNorm() +
                2.0 * innovation.lower.diagonal().array().log().sum();
  }
  EXPECT_NEAR(factored, dense, 0.15);  // what the linearization leaves, of a thousand
}

// Innovations of its own motions are white and of unit size, for one person and for two who touch.
TEST(PendulumFilter, InnovationsOfItsOwnMotionsAreStandardNormal) {
  for (int people : {1, 2}) {
    ModelOptions options;
    options.process_noise = ProcessNoise::kDiagonal;
    options.interaction.spring = options.interaction.damping = people > 1;
    const Scene scene = People(people);
    const std::vector<ParameterSet<double>> p(people, Standing());
    Random random(9);
    constexpr int kFrames = 40, kRuns = 60;
    double sum = 0.0, squares = 0.0, lagged = 0.0;
    int count = 0, pairs = 0;
    for (int run = 0; run < kRuns; ++run) {
      Scene own = scene;
      std::vector<Vector4<double>> rates;
      FrameTable<Vector4<double>> noise(kFrames, people);
      for (int n = 0; n < people; ++n) {
        rates.push_back(RandomVector(&random, 0.0));
        for (double& rate : rates.back()) rate = kStartRate * random.Normal();
        for (int t = 0; t < kFrames; ++t) {
          for (double& w : noise.At(t, n)) w = random.Normal();
        }
      }
      RolloutPath<double> path;
      ASSERT_TRUE(
          Rollout<double>(own, options, p, rates, kFrames, &path, nullptr, nullptr, &noise).ok);
      PendulumFilter filter(own, options, p);
      std::vector<Vector4<double>> before(people, Vector4<double>::Zero());
      for (int t = 0; t + 1 < kFrames; ++t) {
        ASSERT_TRUE(filter.Predict(t).ok);
        for (int n = 0; n < people; ++n) {
          Vector4<double> white_error;
          for (double& w : white_error) w = random.Normal();
          const Vector4<double> measured =
              path.At(t + 1, n).q + MeasurementError(scene.people[n].body, p[n]) * white_error;
          const auto innovation = filter.Update(n, measured, 1.0);
          const Vector4<double> white = SolveLower<double, 4, 1>(innovation.lower, innovation.v);
          sum += white.sum(), squares += white.squaredNorm(), count += 4;
          if (t > 0) lagged += white.dot(before[n]), pairs += 4;
          before[n] = white;
        }
      }
    }
    EXPECT_NEAR(sum / count, 0.0, 4.0 / std::sqrt(count)) << people;
    EXPECT_NEAR(squares / count, 1.0, 4.0 * std::sqrt(2.0 / count)) << people;
    EXPECT_NEAR(lagged / pairs, 0.0, 4.0 / std::sqrt(pairs)) << people;
  }
}

TEST(PendulumFilter, WhatIsNotMeasuredIsKnownLessAndLess) {
  ModelOptions options;
  options.process_noise = ProcessNoise::kDiagonal;
  const Scene scene = People(1);
  const std::vector<ParameterSet<double>> p = {Standing()};
  PendulumFilter filter(scene, options, p);
  double before = filter.covariance(0).trace();
  for (int t = 0; t < 10; ++t) {
    ASSERT_TRUE(filter.Predict(t).ok);
    EXPECT_GT(filter.covariance(0).trace(), before);
    before = filter.covariance(0).trace();
  }
  filter.Update(0, filter.state(0).q, 0.5);
  EXPECT_LT(filter.covariance(0).trace(), before);
}

}  // namespace
}  // namespace pushid
