// Feet that stand and feet that step: who stands where, which foot goes when and how far, and what
// the ground does to that.
#include "models/stance.h"

#include "models/rollout.h"
#include "tests/models/model_samples.h"

namespace pushid {
namespace {

ModelOptions Steps() {
  ModelOptions options;
  options.stance = Stance::kSteps;
  options.push = PushUse::kAsRecorded;
  return options;
}

// Round numbers near those of the published recordings.
ParameterSet<double> SteppingParameters() {
  ParameterSet<double> p{};
  p[kKpTheta] = 900.0, p[kKpPhi] = 950.0, p[kKdTheta] = 200.0, p[kKdPhi] = 320.0;
  p[kTailGain] = 0.3, p[kTailTime] = 0.35;
  p[kSupportFront] = 0.12, p[kSupportBack] = 0.08, p[kSupportSide] = 0.03, p[kFootFront] = 0.2;
  p[kStepGain] = 0.85, p[kStepOnset] = 0.5, p[kStepSwing] = 0.31;
  return p;
}

StanceParameters<double> Stances(const ParameterSet<double>& p) {
  return StanceParameters<double>(p);
}

// One person of 75 kg with the hip 4 cm before the ankles, pushed there for 0.7 s so hard that a
// free body would get this velocity, forwards or (y) to the left.
Scene Pushed(double velocity, double rate = 60.0, bool to_the_left = false) {
  Scene scene;
  scene.dt = 1.0 / rate;
  ScenePerson person;
  person.body = {75.0, kReferenceRod, 0.08};
  person.start.q[2] = std::asin(0.04 / kReferenceRod);
  scene.people.push_back(person);
  const int frames = static_cast<int>(std::lround(0.7 * rate));
  std::vector<Vector4<double>> rows;
  for (int t = 0; t < frames; ++t) {
    const double size = 75.0 * velocity * M_PI / (2 * 0.7) * std::sin(M_PI * (t + 0.5) / frames);
    rows.push_back(GeneralizedForce<double>(
        person.body, Vector4<double>(person.start.q),
        to_the_left ? Vector3<double>(0.0, size, 0.0) : Vector3<double>(size, 0.0, 0.0), 1.0));
  }
  scene.pushes.push_back(MakeScenePush(0, 0, PushKind::kExternal, rows));
  return scene;
}

RolloutPath<double> PathOf(const Scene& scene, const ParameterSet<double>& p, double seconds,
                           ForceTrace* trace = nullptr) {
  RolloutPath<double> path;
  const int frames = static_cast<int>(std::lround(seconds / scene.dt));
  const RolloutStatus status =
      Rollout<double>(scene, Steps(), {p}, InitialVelocities(scene), frames, &path, trace);
  EXPECT_TRUE(status.ok) << status.quantity << " at frame " << status.frame;
  return path;
}

// How far the hip is from where it was, along the axis of the push, at rest.
double HipEnd(double velocity, double rate = 60.0, bool to_the_left = false) {
  const Scene scene = Pushed(velocity, rate, to_the_left);
  const Body& body = scene.people[0].body;
  const RolloutPath<double> path = PathOf(scene, SteppingParameters(), 8.0);
  const PendulumState<double>& end = path.At(path.num_frames() - 1, 0);
  EXPECT_LT(end.qd.norm(), 0.05) << velocity << " m/s, " << rate;
  return (HipPosition(body, end.q) - HipPosition(body, path.At(0, 0).q))[to_the_left ? 1 : 0];
}

// What was measured of others: at 0.15 m/s everybody stands, at 0.6 m/s everybody ends some
// 1.2 s times that away.
TEST(Stance, AWeakPushSwaysAStrongOneSteps) {
  EXPECT_NEAR(HipEnd(0.1), 0.0, 0.01);
  EXPECT_NEAR(HipEnd(0.15), 0.0, 0.02);
  EXPECT_GT(HipEnd(0.6), 0.45);
  EXPECT_LT(HipEnd(0.6), 0.9);
  double before = -0.01;
  for (double velocity : {0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8}) {
    const double end = HipEnd(velocity);
    EXPECT_GT(end, before - 0.01) << velocity;
    before = end;
  }
}

// Steps as short as those forwards would fall short backwards, one after the other for metres.
TEST(Stance, BackwardsAsWell) {
  EXPECT_NEAR(HipEnd(-0.1), 0.0, 0.02);
  EXPECT_LT(HipEnd(-0.3), -0.2);
  EXPECT_GT(HipEnd(-0.3), -0.8);
}

TEST(Stance, ToTheSideAsWell) {
  EXPECT_NEAR(HipEnd(0.1, 60.0, true), 0.0, 0.02);
  EXPECT_GT(HipEnd(0.6, 60.0, true), 0.1);
  EXPECT_LT(HipEnd(0.6, 60.0, true), 0.9);
}

TEST(Stance, DoesNotDependOnTheFrameRate) {
  for (double velocity : {0.15, 0.4, 0.6}) {
    const double end = HipEnd(velocity, 480.0);
    for (double rate : {30.0, 60.0, 120.0}) {
      EXPECT_NEAR(HipEnd(velocity, rate), end, 0.02 + 0.15 * end) << velocity << " m/s, " << rate;
    }
  }
}

TEST(Stance, FeetHoldWhileTheCapturePointIsOverThem) {
  ForceTrace trace;
  const Scene scene = Pushed(0.15);
  const RolloutPath<double> path = PathOf(scene, SteppingParameters(), 2.0, &trace);
  for (int t = 0; t < path.num_frames(); ++t) {
    EXPECT_LT(std::abs(path.At(t, 0).q[0]), 1e-6) << t;
    EXPECT_EQ(path.At(t, 0).feet.swings, 0);
    EXPECT_LE(std::abs(trace.At(t, 0)[ForcePart::kBalance][2]), 0.9 * 75.0 * kGravity * 0.2);
  }
}

// One foot moves and the other stands, wherever the cart between them goes.
TEST(Stance, OneFootStandsWhileTheOtherSteps) {
  const RolloutPath<double> path = PathOf(Pushed(0.5), SteppingParameters(), 3.0);
  const auto foot = [&](int t, int side) {
    const PendulumState<double>& s = path.At(t, 0);
    return Eigen::Vector2d(s.q.head<2>() + 0.5 * side * s.feet.apart);
  };
  int frames_in_air = 0, swings = 0;
  for (int t = 0; t + 1 < path.num_frames(); ++t) {
    const FeetState<double>& next = path.At(t + 1, 0).feet;
    const int flying = path.At(t, 0).feet.swings != 0 ? path.At(t, 0).feet.swings : next.swings;
    for (int side : {-1, 1}) {
      if (side == flying) continue;
      EXPECT_LT((foot(t + 1, side) - foot(t, side)).norm(), 1e-6) << t << ", " << side;
    }
    frames_in_air += next.swings != 0;
    swings += next.swings != 0 && path.At(t, 0).feet.swings == 0;
  }
  EXPECT_EQ(swings, 2);  // and the rear foot is brought up
  EXPECT_NEAR(frames_in_air / 60.0 / swings, 0.33, 0.1);
  EXPECT_LT(std::abs(path.At(path.num_frames() - 1, 0).feet.apart[0]), 0.05);
}

TEST(Stance, TheReactionOfTheGroundIsTheMissingMomentum) {
  ForceTrace trace;
  const Scene scene = Pushed(0.4);
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

// Continuous in a parameter, though steps begin and land in other frames: no jump is larger than
// the way that a foot makes in a frame.
TEST(Stance, PathsAreContinuousInTheParameters) {
  const auto end = [](double onset) {
    ParameterSet<double> p = SteppingParameters();
    p[kStepOnset] = onset;
    const Scene scene = Pushed(0.5);
    const RolloutPath<double> path = PathOf(scene, p, 1.5);
    return HipPosition(scene.people[0].body, path.At(path.num_frames() - 1, 0).q).x();
  };
  double before = end(0.45);
  for (double onset = 0.45; onset < 0.55; onset += 0.0005) {  // six frames of the rollout
    const double now = end(onset);
    EXPECT_NEAR(now, before, 0.002) << onset;
    before = now;
  }
}

// A net push holds the feet's reaction: while it lasts nothing is added, and the ground does not.
TEST(Stance, ANetPushIsTheWholeForce) {
  Scene scene = Pushed(0.4);
  // So short that who is not held by the ground does not fall.
  std::vector<Vector4<double>> rows = scene.pushes[0].force;
  rows.resize(12);
  scene.pushes[0] = MakeScenePush(0, 0, PushKind::kNet, rows);
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

ModelOptions AmongOthers() {
  ModelOptions options = Steps();
  options.interaction.spring = options.interaction.damping = true;
  return options;
}

// One leans 0.15 m forwards, k (h - h0) = 1.26 * 0.15 m = 0.189 m. Alone, and just beyond the edge,
// c is as far as the feet let it (f = 0.2 m; SmoothLimit: 0.162 m). Among others they let
// themselves fall from a third of t_on on: b / 2 = 0.06 m (SmoothLimit: 0.0599 m), while after a
// step k = 2.5, and c is at f.
TEST(Stance, WhoPreparesTheFirstStepAmongOthersLetsThemselvesFall) {
  const ParameterSet<double> p = SteppingParameters();
  const Body body{85.0, kReferenceRod, 0.0};
  const auto pressure = [&](const ModelOptions& options, double clock, int landed) {
    const SelfForce self(options, body, Vector4<double>::Zero(), 1e-4);
    PendulumState<double> state;
    state.q[2] = std::asin(0.15 / kReferenceRod);
    state.feet.clock = clock;
    state.feet.landed = static_cast<signed char>(landed);
    const double torque =
        StanceAt<double>(self.standing, Stances(p), state.feet, state, state).torque[0];
    return -torque / self.weight();
  };
  const double k = 900.0 / (0.9 * 85.0 * kGravity * kReferenceRod);
  for (double clock : {0.0, 0.5 / 6.0, 0.5 / 3.0}) {
    EXPECT_NEAR(pressure(Steps(), clock, 0), SmoothLimit(k * 0.15, 0.2), 1e-6);
  }
  EXPECT_NEAR(pressure(AmongOthers(), 0.0, 0), SmoothLimit(k * 0.15, 0.2), 1e-6);
  EXPECT_NEAR(pressure(AmongOthers(), 0.5 / 6.0, 0), SmoothLimit(k * 0.15, 0.13), 1e-6);  // halfway
  EXPECT_NEAR(pressure(AmongOthers(), 0.5 / 3.0, 0), SmoothLimit(k * 0.15, 0.06), 1e-6);
  EXPECT_NEAR(pressure(AmongOthers(), 0.0, 1), SmoothLimit(2.5 * 0.15, 0.2), 1e-6);
}

// The capture point 0.24 m before the ankles, twice the support: S(1) = 1.01, and a first step that
// takes 0.31 s of who is alone takes 0.31 s / 1.25 among others.
TEST(Stance, StepsAfterHarderPushesAreQuickerAmongOthers) {
  const ParameterSet<double> p = SteppingParameters();
  PendulumState<double> state;
  state.q[2] = std::asin(0.24 / kReferenceRod);
  state.feet.clock = p[kStepOnset];
  for (const ModelOptions& options : {Steps(), AmongOthers()}) {
    const SelfForce self(options, {85.0, kReferenceRod, 0.0}, Vector4<double>::Zero(), 1e-6);
    const FeetState<double> next =
        StanceAt<double>(self.standing, Stances(p), state.feet, state, state).next;
    EXPECT_NE(next.swings, 0);
    const double quicker = options.interaction.Any() ? 0.25 * 0.5 * (1.0 + std::sqrt(1.04)) : 0.0;
    EXPECT_NEAR(next.swing_time, 0.31 / (1.0 + quicker), 1e-5);
  }
}

// The push goes through the row, everybody steps forwards, nobody falls, and in time all stand.
TEST(Stance, ARowThatWasPushedStandsAgain) {
  ParameterSet<double> p = SteppingParameters();
  p[kContactStiffness] = 4000.0, p[kContactDamping] = 500.0;
  p[kContactDistance] = 0.42, p[kContactKappa] = 0.53, p[kContactHeight] = 0.95;
  for (double impulse : {20.0, 80.0}) {
    const Scene scene = SettlingScene(80.0, impulse, 5);
    RolloutPath<double> path;
    const int settled = scene.SettledFrame(AmongOthers());
    ASSERT_TRUE(
        Rollout<double>(scene, AmongOthers(), {p}, InitialVelocities(scene), settled + 60, &path)
            .ok);
    for (int n = 0; n < 5; ++n) {
      SCOPED_TRACE(std::to_string(impulse) + " N s, person " + std::to_string(n));
      for (int t = settled; t < settled + 60; ++t) {
        EXPECT_LT(path.At(t, n).qd.head<2>().norm(), kSettledSpeed) << t;
        EXPECT_LT(path.At(t, n).q.tail<2>().norm(), kSettledLean) << t;
      }
      const double way = path.At(settled, n).q[0] - scene.people[n].start.q[0];
      EXPECT_NEAR(way, impulse > 50.0 ? 0.3 : 0.0, impulse > 50.0 ? 0.25 : 0.01);
    }
  }
}

// Lift-off and landing move through the frames as a step takes longer to prepare, and nothing jumps
// where they cross one: neither the hip in the end nor the cost of a fit, which is why a solver can
// descend.
TEST(Stance, PathsAreContinuousWhereStepsCrossFrames) {
  constexpr double kFrom = 0.45, kTo = 0.55, kPart = 1e-4;  // s
  ParameterSet<double> p = SteppingParameters();
  p[kContactStiffness] = 4000.0, p[kContactDamping] = 500.0;
  p[kContactDistance] = 0.42, p[kContactKappa] = 0.53, p[kContactHeight] = 0.95;
  const Scene scene = SettlingScene(80.0, 60.0, 3);
  const int frames = static_cast<int>(std::lround(1.6 / scene.dt));
  const auto path_at = [&](double onset) {
    p[kStepOnset] = onset;
    RolloutPath<double> path;
    EXPECT_TRUE(
        Rollout<double>(scene, AmongOthers(), {p}, InitialVelocities(scene), frames, &path).ok);
    return path;
  };
  double most = 0.0;
  RolloutPath<double> before = path_at(kFrom);
  int crossings = 0;
  for (double onset = kFrom + kPart; onset < kTo; onset += kPart) {
    const RolloutPath<double> path = path_at(onset);
    for (int n = 0; n < 3; ++n) {
      for (int t = 0; t < frames; ++t) {
        const PendulumState<double>&now = path.At(t, n), &then = before.At(t, n);
        crossings += now.feet.swings != then.feet.swings;
        most = std::max(most, (now.q - then.q).norm());
      }
    }
    before = path;
  }
  EXPECT_GT(crossings, 20);
  EXPECT_LT(most, 10.0 * kPart);  // of the hip and ankles, m, rad
}

// At rest, at the edges and far out: finite everywhere.
TEST(Stance, IsFiniteAtTheEdges) {
  const ParameterSet<double> p = SteppingParameters();
  const Body body{80.0, 0.95, 0.1};
  const SelfForce self(Steps(), body, Vector4<double>::Zero(), 1.0 / 60);
  for (double offset : {0.0, 1e-300, 1e-12, 0.1, -0.06, 1.0}) {
    for (double clock : {0.0, 0.499999, 0.6}) {
      for (int swings : {-1, 0, 1}) {
        for (int landed : {-1, 0, 1}) {
          PendulumState<double> state;
          state.q[2] = std::asin(offset / 0.95 * 0.9);
          state.feet.clock = clock;
          state.feet.swing_time = 0.3;
          state.feet.swings = static_cast<signed char>(swings);
          state.feet.landed = static_cast<signed char>(landed);
          const StanceForces<double> forces =
              StanceAt<double>(self.standing, Stances(p), state.feet, state, state);
          EXPECT_TRUE(forces.torque.allFinite() && forces.velocity.allFinite());
          EXPECT_TRUE(forces.next.apart.allFinite() && std::isfinite(forces.next.clock));
        }
      }
    }
  }
}

}  // namespace
}  // namespace pushid
