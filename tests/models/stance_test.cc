// Feet that stand and feet that step: what holds, what lets go, what a torque inside the body can
// do.
#include "models/stance.h"

#include "models/rollout.h"
#include "tests/models/model_samples.h"

namespace pushid {
namespace {

ModelOptions Threshold() {
  ModelOptions options;
  options.stance = Stance::kThreshold;
  options.push = PushUse::kAsRecorded;
  return options;
}

// Round numbers near those of the published recordings.
ParameterSet<double> SteppingParameters() {
  ParameterSet<double> p{};
  p[kMu] = p[kMuY] = 80.0, p[kAx] = 15.0, p[kAy] = 15.0;
  p[kKpTheta] = p[kKpPhi] = 1150.0, p[kKdTheta] = p[kKdPhi] = 330.0;
  p[kTailGain] = 2.0, p[kTailTime] = 0.2;
  p[kSupportFront] = 0.1, p[kSupportBack] = 0.06, p[kSupportSide] = 0.1, p[kAnkleReach] = 1.5;
  p[kStepGain] = 1.0, p[kStepOnset] = 0.13, p[kStepRelease] = 0.4, p[kStaticFriction] = 1.0;
  return p;
}

StanceParameters<double> Stances(const ParameterSet<double>& p) {
  return StanceParameters<double>([&p](Parameter id) { return p[id]; });
}

// One person of 80 kg, pushed at the hip along x for 0.7 s.
Scene PushedFor(double impulse, double rate = 60.0) {
  Scene scene;
  scene.dt = 1.0 / rate;
  ScenePerson person;
  person.body = {80.0, kReferenceRod, 0.08};
  scene.people.push_back(person);
  const int frames = static_cast<int>(std::lround(0.7 * rate));
  scene.pushes.push_back(MakeScenePush(0, 0, PushKind::kExternal,
                                       HalfSinePush(person.body, impulse, frames, scene.dt)));
  return scene;
}

RolloutPath<double> PathOf(const Scene& scene, const ParameterSet<double>& p, double seconds,
                           ForceTrace* trace = nullptr) {
  RolloutPath<double> path;
  const int frames = static_cast<int>(std::lround(seconds / scene.dt));
  const RolloutStatus status =
      Rollout<double>(scene, Threshold(), {p}, InitialVelocities(scene), frames, &path, trace);
  EXPECT_TRUE(status.ok) << status.quantity << " at frame " << status.frame;
  return path;
}

double HipEnd(double impulse, double rate = 60.0) {
  const Scene scene = PushedFor(impulse, rate);
  const RolloutPath<double> path = PathOf(scene, SteppingParameters(), 4.0);
  const PendulumState<double>& end = path.At(path.num_frames() - 1, 0);
  EXPECT_LT(end.qd.norm(), 0.1);
  return HipPosition(scene.people[0].body, end.q).x();
}

TEST(Stance, AWeakPushSwaysAStrongOneSteps) {
  EXPECT_NEAR(HipEnd(10.0), 0.0, 0.02);
  EXPECT_GT(HipEnd(40.0), 0.2);
  EXPECT_LT(HipEnd(40.0), 0.8);
  double before = -0.01;
  for (double impulse : {5.0, 10.0, 15.0, 20.0, 30.0, 40.0, 60.0}) {
    const double end = HipEnd(impulse);
    EXPECT_GT(end, before - 0.01) << impulse << " N s";
    before = end;
  }
}

TEST(Stance, DoesNotDependOnTheFrameRate) {
  for (double impulse : {10.0, 40.0, 60.0}) {
    const double end = HipEnd(impulse, 240.0);
    for (double rate : {30.0, 60.0, 120.0}) {
      EXPECT_NEAR(HipEnd(impulse, rate), end, 0.02 + 0.15 * end) << impulse << " N s, " << rate;
    }
  }
}

TEST(Stance, FeetHoldWhileTheCapturePointIsOverThem) {
  ForceTrace trace;
  const Scene scene = PushedFor(10.0);
  const RolloutPath<double> path = PathOf(scene, SteppingParameters(), 2.0, &trace);
  const double most = 0.9 * 80.0 * kGravity * 0.1 * 1.5;
  for (int t = 0; t < path.num_frames(); ++t) {
    EXPECT_LT(std::abs(path.At(t, 0).q[0]), 0.003) << t;
    EXPECT_LT(path.At(t, 0).step, 1e-3);
    EXPECT_LE(std::abs(trace.At(t, 0)[ForcePart::kBalance][2]), most);
  }
}

// On ice the same push makes the feet slip.
TEST(Stance, StaticFrictionIsLimited) {
  ParameterSet<double> ice = SteppingParameters();
  ice[kStaticFriction] = 0.005;
  const Scene scene = PushedFor(15.0);
  const RolloutPath<double> firm = PathOf(scene, SteppingParameters(), 1.0);
  const RolloutPath<double> slips = PathOf(scene, ice, 1.0);
  double moved = 0.0;
  for (int t = 0; t < firm.num_frames(); ++t) {
    moved = std::max(moved, std::abs(slips.At(t, 0).q[0] - firm.At(t, 0).q[0]));
  }
  EXPECT_GT(moved, 0.01);
}

TEST(Stance, TheReactionOfTheGroundIsTheMissingMomentum) {
  ForceTrace trace;
  const Scene scene = PushedFor(30.0);
  const Body& body = scene.people[0].body;
  const RolloutPath<double> path = PathOf(scene, SteppingParameters(), 2.0, &trace);
  const auto momentum = [&](int t) {
    const PendulumState<double>& s = path.At(t, 0);
    return body.mass * s.qd[0] + body.point_mass() * body.rod_length * std::cos(s.q[2]) * s.qd[2];
  };
  double received = 0.0;
  for (int t = 0; t + 1 < path.num_frames(); ++t) {
    received += scene.dt * trace.At(t, 0).Total()[0];
    EXPECT_NEAR(momentum(t + 1), received, 0.6) << t;  // N s, of some 30
  }
}

// The way back from a switch is slower than the switch.
TEST(Stance, TheStepStateIsLatched) {
  const StanceParameters<double> p = Stances(SteppingParameters());
  double s = 0.0;
  for (int t = 0; t < 18; ++t) s = NextStepState(p, 2.0, s, 1.0 / 60);
  EXPECT_GT(s, 0.85);
  const double stepping = s;
  for (int t = 0; t < 18; ++t) s = NextStepState(p, 0.5, s, 1.0 / 60);
  EXPECT_GT(s, 0.4 * stepping);
  for (int t = 0; t < 120; ++t) s = NextStepState(p, 0.5, s, 1.0 / 60);
  EXPECT_LT(s, 0.05);
}

TEST(Stance, CapturePointIsThatOfTheHip) {
  Random random(5);
  for (int trial = 0; trial < 50; ++trial) {
    const Body body = RandomBody(&random);
    const PendulumState<double> state = RandomState(&random, 0.3);
    const Eigen::Vector2d posture(random.Uniform(-0.1, 0.1), random.Uniform(-0.1, 0.1));
    constexpr double kStep = 1e-6;
    const Vector4<double> after = state.q + kStep * state.qd, before = state.q - kStep * state.qd;
    const Eigen::Vector2d velocity =
        (HipPosition(body, after) - HipPosition(body, before)).head<2>() / (2 * kStep);
    const Vector4<double> rest(state.q[0], state.q[1], posture[0], posture[1]);
    const Eigen::Vector2d place =
        (HipPosition(body, state.q) - HipPosition<double>(body, rest)).head<2>();
    const Eigen::Vector2d expected = place + velocity / std::sqrt(kGravity / body.rod_length);
    const SelfForce self(Threshold(), body, rest, 1.0 / 60);
    ExpectClose(CaptureOffset(self, Angles<double>(state.q), state.qd), expected, 1e-8);
  }
}

// The torque between legs and trunk does what it says, and its momentum is the cart forces' alone.
TEST(Stance, FootTorqueMovesTheCartAsAsked) {
  Random random(6);
  ParameterSet<double> parameters = SteppingParameters();
  parameters[kStepGain] = 1.3;
  const StanceParameters<double> p = Stances(parameters);
  for (int trial = 0; trial < 50; ++trial) {
    const Body body = RandomBody(&random);
    const PendulumState<double> state = RandomState(&random, 0.2);
    const Eigen::Vector2d capture(random.Uniform(-0.3, 0.3), random.Uniform(-0.3, 0.3));
    const Eigen::Vector2d cart(random.Uniform(-200, 200), random.Uniform(-200, 200));
    constexpr double kDt = 1.0 / 60;
    const SelfForce self(Threshold(), body, Vector4<double>::Zero(), kDt);
    const Eigen::Vector2d torque =
        FootTorque<double>(self, p, Angles<double>(state.q), state.qd, capture, cart);
    const Vector4<double> qdd =
        Acceleration<double>(body, state, {cart[0], cart[1], torque[0], torque[1]});
    const double rate = FootRate(kDt);
    const Eigen::Vector2d wanted = rate * (1.3 * self.capture_rate * capture - state.qd.head<2>());
    ExpectClose(Eigen::Vector2d(qdd.head<2>()), wanted, 1e-8);
  }
}

TEST(Stance, LimitIsSmoothAndKept) {
  for (double u : {-30.0, -1.0, -0.8, -0.3, 0.0, 0.3, 0.8, 1.0, 5.0, 1e4}) {
    EXPECT_LE(std::abs(SmoothLimit(u, 1.0)), 1.0);
    EXPECT_NEAR(SmoothLimit(40.0 * u, 40.0), 40.0 * SmoothLimit(u, 1.0), 1e-12 * 40.0);
    if (std::abs(u) > 0.8) continue;
    EXPECT_NEAR(SmoothLimit(u, 1.0), u, 0.09 * std::abs(u));
  }
}

// A net push holds the feet's reaction: while it lasts nothing is added, and the feet do not hold.
TEST(Stance, ANetPushIsTheWholeForce) {
  Scene scene = PushedFor(30.0);
  scene.pushes[0].kind = PushKind::kNet;
  ForceTrace trace;
  PathOf(scene, SteppingParameters(), 1.5, &trace);
  for (int t = 0; t < scene.pushes[0].EndFrame(); ++t) {
    EXPECT_EQ(trace.At(t, 0).Total(), scene.pushes[0].force[t]);
  }
  scene.pushes[0].kind = PushKind::kNetWithoutFriction;
  const RolloutPath<double> other = PathOf(scene, SteppingParameters(), 1.5, &trace);
  for (int t = 1; t < scene.pushes[0].EndFrame(); ++t) {
    const Vector4<double> rest = trace.At(t, 0).Total() - scene.pushes[0].force[t];
    const Vector4<double>& qd = other.At(t, 0).qd;
    ExpectClose(rest, Vector4<double>(-100.0 * qd[0], -100.0 * qd[1], 0.0, 0.0), 1e-10);
  }
}

// At rest, at the edges and far out: finite everywhere.
TEST(Stance, IsFiniteAtTheEdges) {
  const ParameterSet<double> p = SteppingParameters();
  const Body body{80.0, 0.95, 0.1};
  const SelfForce self(Threshold(), body, Vector4<double>::Zero(), 1.0 / 60);
  for (double offset : {0.0, 1e-300, 1e-12, 0.1, -0.06, 1.0}) {
    for (double step : {0.0, 0.5, 1.0}) {
      PendulumState<double> state;
      state.q[2] = std::asin(offset / 0.95 * 0.9);
      state.step = step;
      const StanceForces<double> forces = StanceAt<double>(
          self, Stances(p), Angles<double>(state.q), state, Perceived<double>(state), {0.0, 0.0});
      EXPECT_TRUE(forces.torque.allFinite());
      EXPECT_TRUE(std::isfinite(forces.ground) && std::isfinite(forces.next_step));
      EXPECT_GE(forces.next_step, 0.0);
      EXPECT_LE(forces.next_step, 1.0);
    }
  }
}

}  // namespace
}  // namespace pushid
