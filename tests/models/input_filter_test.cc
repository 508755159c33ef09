// The filter of unknown forces, on people who are pushed by forces that it is not told of.
#include "models/input_filter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "models/rollout.h"
#include "tests/models/model_samples.h"

namespace pushid {
namespace {

ParameterSet<double> Recovering() {
  ParameterSet<double> p{};
  p[kMu] = p[kMuY] = 20.0, p[kKpTheta] = p[kKpPhi] = 1200.0, p[kKdTheta] = p[kKdPhi] = 400.0;
  p[kAx] = p[kAy] = -3.0, p[kTailTime] = 0.2;
  return p;
}

Scene OnePerson() {
  Scene scene;
  ScenePerson person;
  person.body = {78.0, 0.94, 0.08};
  person.start.q = {0.0, 0.0, 0.03, -0.02};
  scene.people.push_back(person);
  scene.pushes.push_back(MakeScenePush(0, 0, PushKind::kExternal,
                                       std::vector<Vector4<double>>(8, {90.0, 30.0, 70.0, -20.0})));
  return scene;
}

ModelOptions Isotropic() {
  ModelOptions options;
  options.friction = FrictionKind::kAnisotropic;
  return options;
}

// A person under the known push and a force of the filter's own law, measured as it says.
struct Hidden {
  RolloutPath<double> path;
  std::vector<PendulumState<double>> measured;
  std::vector<Vector4<double>> force;
};
Hidden Simulate(const Scene& known, const InputNoise& noise, int frames, double strength,
                Random* random) {
  Hidden hidden;
  const Body& body = known.people[0].body;
  const double m = body.mass, l = body.pendulum_length(), dt = known.dt;
  const double r = std::exp(-dt / noise.force_time), e = std::exp(-dt / noise.measured_time);
  const auto normal = [&] {
    return Vector4<double>(random->Normal(), random->Normal(), random->Normal(), random->Normal());
  };
  const Vector4<double> force_scale = strength * noise.force * Vector4<double>(m, m, m * l, m * l);
  const Vector4<double> error_scale = noise.measured * Vector4<double>(1.0, 1.0, 1.4 / l, 1.4 / l);
  Vector4<double> force = Vector4<double>::Zero(), error = error_scale.cwiseProduct(normal());
  for (int t = 0; t < frames; ++t) {
    hidden.force.push_back(force);
    force = r * force + std::sqrt(1.0 - r * r) * force_scale.cwiseProduct(normal());
  }
  Scene scene = known;
  scene.pushes.push_back(MakeScenePush(0, 0, PushKind::kExternal, hidden.force));
  const RolloutStatus status = Rollout<double>(scene, Isotropic(), {Recovering()},
                                               InitialVelocities(scene), frames, &hidden.path);
  EXPECT_TRUE(status.ok);
  for (int t = 0; t < frames; ++t) {
    hidden.measured.push_back(hidden.path.At(t, 0));
    if (t > 0) hidden.measured.back().q += error;
    error = e * error + std::sqrt(1.0 - e * e) * error_scale.cwiseProduct(normal());
  }
  return hidden;
}

// last: the frame of b at which a forecast begins.
double HipError(const Scene& scene, const RolloutPath<double>& a, const RolloutPath<double>& b,
                int last, int frame) {
  const Body& body = scene.people[0].body;
  return (HipPosition(body, a.At(frame - last, 0).q) - HipPosition(body, b.At(frame, 0).q)).norm();
}

// Forecasts from the force that it finds are better than without.
TEST(InputFilter, FindsForcesThatItIsNotToldOf) {
  const InputNoise noise{0.2, 1.5, 0.002, 0.1};
  InputNoise none = noise;
  none.force = 1e-6;
  const Scene scene = OnePerson();
  const ModelOptions options = Isotropic();
  Random random(5);
  double with = 0.0, without = 0.0;
  for (int trial = 0; trial < 60; ++trial) {
    const Hidden hidden = Simulate(scene, noise, 75, 1.0, &random);
    InputFilter filter(scene, options, {Recovering()}, noise);
    InputFilter blind(scene, options, {Recovering()}, none);
    for (int t = 1; t <= 45; ++t) {
      ASSERT_TRUE(filter.Observe({hidden.measured[t]}, {true}).ok);
      ASSERT_TRUE(blind.Observe({hidden.measured[t]}, {true}).ok);
    }
    RolloutPath<double> path, from_blind;
    const int ahead = 74 - 45;
    ASSERT_TRUE(filter.Forecast(ahead, &path).ok);
    ASSERT_TRUE(blind.Forecast(ahead, &from_blind).ok);
    with += HipError(scene, path, hidden.path, 45, 57);
    without += HipError(scene, from_blind, hidden.path, 45, 57);
  }
  EXPECT_LT(with, 0.8 * without);
}

// Where everything is known, the believed force stays small and the forecast is the rollout.
TEST(InputFilter, AKnownPushNeedsNoOther) {
  const InputNoise noise;
  const Scene scene = OnePerson();
  const ModelOptions options = Isotropic();
  Random random(6);
  InputNoise exact = noise;
  exact.measured = 1e-9;
  const Hidden hidden = Simulate(scene, exact, 75, 0.0, &random);
  InputFilter filter(scene, options, {Recovering()}, noise);
  for (int t = 1; t <= 30; ++t) filter.Observe({hidden.measured[t]}, {true});
  EXPECT_LT(filter.Input(0).norm(), 1e-4);
  RolloutPath<double> path;
  const int ahead = 74 - 30;
  ASSERT_TRUE(filter.Forecast(ahead, &path).ok);
  EXPECT_LT(HipError(scene, path, hidden.path, 30, 74), 1e-6);
}

// What a measurement moves settles and stays so: rounding once made the covariance lopsided, and
// after 25 frames velocities were no longer corrected.
TEST(InputPlane, SettlesAndStays) {
  const InputPlane::Gains gains{0.0, 400.0, 570.0, -100.0};
  InputPlane plane({67.0, 0.968, 0.09}, gains, InputNoise{0.06, 4.0, 0.0012, 0.13}, 1.0 / 60.0);
  Random random(9);
  InputPlane::Correction early;
  for (int t = 1; t < 2000; ++t) {
    plane.Predict();
    const Eigen::Vector2d seen(random.Normal(), random.Normal());
    InputPlane copy = plane;
    const InputPlane::Correction moved = copy.Update({1e-3, 0.0});
    plane.Update(1e-3 * seen);
    if (t == 20) early = moved;
    if (t > 20) {
      ASSERT_LT((moved - early).norm(), 1e-2 * early.norm()) << t;
    }
  }
}

// Not corrected it is the rollout, however late people react and however many frames there were;
// pushes may be told as they come.
TEST(InputFilter, WithoutNoiseGoesOnAsTheRollout) {
  constexpr int kFrames = 400;
  ModelOptions options = Isotropic();
  options.delay = Delay::kOne;
  ParameterSet<double> p = Recovering();
  p[kReactionDelay] = 0.06, p[kKdTheta] = p[kKdPhi] = 150.0;
  Scene scene = OnePerson();
  scene.people[0].start.q.tail<2>().setZero();
  std::vector<GroundPose> poses;
  for (int t = 0; t < kFrames; ++t) poses.push_back({0.02 * std::sin(0.05 * t), 0, 0, 0});
  scene.ground = GroundThrough(poses, scene.dt);
  scene.pushes[0].start_frame = 150;
  RolloutPath<double> path;
  ASSERT_TRUE(Rollout<double>(scene, options, {p}, InitialVelocities(scene), kFrames, &path).ok);
  const std::vector<Vector4<double>> rows = scene.pushes[0].force;
  scene.pushes.clear();
  InputFilter filter(scene, options, {p}, std::nullopt);
  RolloutPath<double> ahead;
  for (int t = 0; t + 1 < kFrames; ++t) {
    if (t >= 150 && t < 158) filter.Push(0, rows[t - 150]);
    if (t >= 160 || (t >= 100 && t < 130)) {
      ASSERT_TRUE(filter.Forecast(kFrames - 1 - t < 20 ? kFrames - 1 - t : 20, &ahead).ok);
      const int last = ahead.num_frames() - 1;
      EXPECT_LT((ahead.At(last, 0).q - path.At(t + last, 0).q).norm(), 1e-12) << t;
    }
    ASSERT_TRUE(filter.Observe({path.At(t + 1, 0)}, {false}).ok);
    ASSERT_LT((filter.state(0).q - path.At(t + 1, 0).q).norm(), 1e-12) << t;
  }
}

// A frame that was not seen may say anything.
TEST(InputFilter, LooksAtNothingUnseen) {
  const InputNoise noise;
  const Scene scene = OnePerson();
  const ModelOptions options = Isotropic();
  Random random(7);
  const Hidden hidden = Simulate(scene, noise, 40, 1.0, &random);
  Vector4<double> inputs[2];
  for (int wild : {0, 1}) {
    InputFilter filter(scene, options, {Recovering()}, noise);
    for (int t = 1; t <= 20; ++t) {
      PendulumState<double> state = hidden.measured[t];
      if (wild && t == 12) state.q.setConstant(3.0);
      filter.Observe({state}, {t != 12});
    }
    inputs[wild] = filter.Input(0);
  }
  EXPECT_EQ(inputs[0], inputs[1]);
}

// Pushed and seen along -y instead of x, the filter believes the same force along -y.
TEST(InputFilter, DoesNotCareWhereForward) {
  const InputNoise noise;
  const ModelOptions options = Isotropic();
  Scene along = OnePerson(), across = OnePerson();
  along.people[0].start.q.setZero();
  across.people[0].start.q.setZero();
  along.pushes = {MakeScenePush(0, 0, PushKind::kExternal, {{90.0, 0.0, 70.0, 0.0}})};
  across.pushes = {MakeScenePush(0, 0, PushKind::kExternal, {{0.0, 90.0, 0.0, -70.0}})};
  InputFilter first(along, options, {Recovering()}, noise);
  InputFilter second(across, options, {Recovering()}, noise);
  for (int t = 1; t < 20; ++t) {
    PendulumState<double> state, turned;
    state.q = {1e-3 * t * t, 0.0, 4e-3 * t, 0.0};
    turned.q = {0.0, state.q[0], 0.0, -state.q[2]};
    first.Observe({state}, {true});
    second.Observe({turned}, {true});
  }
  EXPECT_GT(std::abs(first.Input(0)[0]), 1.0);
  EXPECT_NEAR(second.Input(0)[1], first.Input(0)[0], 1e-9 * std::abs(first.Input(0)[0]));
  EXPECT_NEAR(second.Input(0)[3], -first.Input(0)[2], 1e-9 * std::abs(first.Input(0)[2]));
}

// Two in contact, one of whom is pushed by a force nobody measured, at another frame rate.
TEST(InputFilter, OfTwoInContactItFindsWhoIsPushed) {
  Scene scene = OnePerson();
  scene.dt = 0.01;
  scene.pushes.clear();
  scene.people.push_back(scene.people[0]);
  scene.people[1].start.q[0] = 0.35;
  ModelOptions options = Isotropic();
  options.interaction.spring = options.interaction.damping = true;
  ParameterSet<double> p = Recovering();
  p[kContactStiffness] = 1500.0, p[kContactDistance] = 0.4, p[kContactKappa] = 0.6;
  p[kContactDamping] = 100.0, p[kContactHeight] = 0.5;
  Scene pushed = scene;
  pushed.pushes.push_back(
      MakeScenePush(0, 0, PushKind::kExternal, std::vector<Vector4<double>>(60, {80, 0, 0, 0})));
  RolloutPath<double> path;
  ASSERT_TRUE(Rollout<double>(pushed, options, {p, p}, InitialVelocities(pushed), 60, &path).ok);
  InputFilter filter(scene, options, {p, p}, InputNoise{0.2, 2.0, 0.001, 0.1});
  for (int t = 1; t < 50; ++t) {
    ASSERT_TRUE(filter.Observe({path.At(t, 0), path.At(t, 1)}, {true, true}).ok);
  }
  EXPECT_NEAR(filter.Input(0)[0], 80.0, 15.0);
  EXPECT_LT(std::abs(filter.Input(1)[0]), 15.0);
}

}  // namespace
}  // namespace pushid
