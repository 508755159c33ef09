// A body that turns about its ankles: by hand, against what holds it, and the same in all
// directions.
#include "models/standing.h"

#include <Eigen/Geometry>

#include "models/rollout.h"
#include "tests/models/model_samples.h"

namespace pushid {
namespace {

ModelOptions Fixed() {
  ModelOptions options;
  options.stance = Stance::kFixed;
  options.push = PushUse::kAsRecorded;
  return options;
}

ParameterSet<double> Gains(double kp, double kd) {
  ParameterSet<double> p{};
  p[kKpTheta] = p[kKpPhi] = kp, p[kKdTheta] = p[kKdPhi] = kd;
  p[kComHeight] = 1.09;
  return p;
}

Vector4<double> Pose(double theta, double phi) { return {0.0, 0.0, theta, phi}; }

Eigen::Vector2d TorqueAt(const SelfForce& self, const ParameterSet<double>& p,
                         const Vector4<double>& q, const Vector4<double>& qd) {
  return StandingTorque(self, p, Angles<double>(q), qd);
}

// The reference person leans forwards by 0.1 rad, at 0.2 rad/s: 1250 N m/rad and 300 N m s/rad ask
// for 125 + 60 N m; at 85 kg and 0.95 m gains are what they are quoted as.
TEST(Standing, TorqueByHand) {
  const SelfForce self(Fixed(), Body{}, Pose(0.0, 0.0), 1.0 / 60.0);
  const ParameterSet<double> p = Gains(1250.0, 300.0);
  const Eigen::Vector2d torque = TorqueAt(self, p, Pose(0.1, 0.0), {0.0, 0.0, 0.2, 0.0});
  EXPECT_NEAR(torque[0], -185.0, 1e-3);
  EXPECT_NEAR(torque[1], 0.0, 1e-12);
  // phi turns towards -y, and asks for as much.
  EXPECT_NEAR(TorqueAt(self, p, Pose(0.0, 0.1), {0.0, 0.0, 0.0, 0.2})[1], -185.0, 1e-3);
}

// 85 kg: 82.45 kg above the ankles, 1.0355 m up, turn with 1.15 m h^2 = 101.7 kg m^2.
TEST(Standing, BodyByHand) {
  const BodyOf<double> body = StandingBody(Body{}, 1.09);
  const double l = body.pendulum_length();
  EXPECT_NEAR(body.point_mass() * l, 82.45 * 1.0355, 1e-9);
  EXPECT_NEAR(body.point_mass() * l * l, 1.15 * 82.45 * 1.0355 * 1.0355, 1e-9);
}

// What the angle over its sine stands for, up to where people lean.
TEST(Standing, AngleOverSine) {
  for (double a : {0.0, 1e-6, 0.1, 0.3, 0.6}) {
    const double s = std::sin(a);
    EXPECT_NEAR(AngleOverSine(s * s), a > 0.0 ? a / s : 1.0, 1e-4) << a;
  }
}

Scene Pushed(const Vector4<double>& q0, double impulse, double direction) {
  Scene scene;
  ScenePerson person;
  person.body = {70.0, 0.9, 0.08};
  person.start.q = q0;
  scene.people.push_back(person);
  std::vector<Vector4<double>> rows;
  constexpr int kRows = 18;
  for (int t = 0; t < kRows; ++t) {
    const double f = impulse * M_PI / (2 * kRows * scene.dt) * std::sin(M_PI * (t + 0.5) / kRows);
    rows.push_back(GeneralizedForce<double>(
        person.body, q0, {f * std::cos(direction), f * std::sin(direction), 0.0}, 1.0));
  }
  scene.pushes.push_back(MakeScenePush(0, 0, PushKind::kExternal, rows));
  return scene;
}

RolloutPath<double> PathOf(const Scene& scene, const ParameterSet<double>& p, int frames,
                           ForceTrace* trace = nullptr) {
  RolloutPath<double> path;
  const RolloutStatus status =
      Rollout<double>(scene, Fixed(), {p}, InitialVelocities(scene), frames, &path, trace);
  EXPECT_TRUE(status.ok) << status.quantity << " at frame " << status.frame;
  return path;
}

// Whoever leans at the start stays so: the ankles hold the posture against gravity.
TEST(Standing, HoldsThePostureAndTheFeet) {
  const Vector4<double> q0 = Pose(0.06, -0.03);
  const RolloutPath<double> rest = PathOf(Pushed(q0, 0.0, 0.0), Gains(1250.0, 300.0), 300);
  EXPECT_LT((rest.At(299, 0).q - q0).norm(), 1e-6);
  ForceTrace trace;
  const Scene scene = Pushed(q0, 12.0, 0.4);
  const RolloutPath<double> path = PathOf(scene, Gains(1250.0, 300.0), 300, &trace);
  double farthest = 0.0;
  for (int t = 0; t < 300; ++t) {
    EXPECT_LT(path.At(t, 0).q.head<2>().norm(), 1e-5);
    farthest = std::max(farthest, (path.At(t, 0).q - q0).tail<2>().norm());
  }
  EXPECT_GT(farthest, 0.03);
  EXPECT_LT((path.At(299, 0).q - q0).norm(), 1e-3);
  // The ground pushes back with what the body does not take up.
  EXPECT_LT(trace.At(9, 0)[ForcePart::kFriction][0], -20.0);
}

// Small sways have the frequency of the linear pendulum, ((Kp - m g h) / J)^1/2.
TEST(Standing, SwaysAtItsFrequency) {
  const ParameterSet<double> p = Gains(1800.0, 1e-3);
  Scene scene = Pushed(Pose(0.0, 0.0), 0.0, 0.0);
  scene.dt = 1e-3;
  scene.people[0].start.qd[2] = 0.02;
  const RolloutPath<double> path = PathOf(scene, p, 3000);
  std::vector<int> crossings;
  for (int t = 1; t < 3000; ++t) {
    if (path.At(t - 1, 0).q[2] * path.At(t, 0).q[2] < 0.0) crossings.push_back(t);
  }
  ASSERT_GE(crossings.size(), 2u);
  const double h = 1.09 * 0.9, m = 0.97 * 70.0, kp = 1800.0 * 70.0 / 85.0 * 0.9 / 0.95;
  const double rate = std::sqrt((kp - m * kGravity * h) / (1.15 * m * h * h));
  EXPECT_NEAR((crossings[1] - crossings[0]) * scene.dt, M_PI / rate, 3e-3);
}

// Posture, push and all turned about the vertical turn the motion, and nothing else.
TEST(Standing, IsTheSameInAllDirections) {
  const auto lean = [](double size, double direction) {
    const double x = size * std::cos(direction), y = size * std::sin(direction);
    const double theta = std::asin(x);
    return Pose(theta, std::asin(-y / std::cos(theta)));
  };
  const ParameterSet<double> p = Gains(1250.0, 200.0);
  const auto hip = [&](double turn) {
    const Scene scene = Pushed(lean(0.08, 0.5 + turn), 11.0, turn);
    const RolloutPath<double> path = PathOf(scene, p, 90);
    return HipPosition<double>(scene.people[0].body, path.At(60, 0).q);
  };
  const Vector3<double> straight = hip(0.0);
  for (double turn : {0.5, 1.3, 2.6}) {
    const Vector3<double> back =
        Eigen::AngleAxisd(-turn, Vector3<double>::UnitZ()) * Vector3<double>(hip(turn));
    // Euler's steps are not those of a turned frame; they differ by less than the noise of markers.
    EXPECT_LT((back - straight).norm(), 5e-4) << turn;
  }
}

// What acts on sliding feet does not act here.
TEST(Standing, DragDoesNotAct) {
  const ModelOptions fixed = Fixed();
  for (Parameter id : {kMu, kMuY, kKpX, kAx, kAy, kBx, kTx, kCq, kDq, kTailGain, kSupportFront}) {
    EXPECT_FALSE(Acts(id, fixed)) << kParameterNames[id];
  }
  for (Parameter id : {kKpTheta, kKpPhi, kKdTheta, kKdPhi, kComHeight}) {
    EXPECT_TRUE(Acts(id, fixed)) << kParameterNames[id];
  }
}

}  // namespace
}  // namespace pushid
