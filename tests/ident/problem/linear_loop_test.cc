// The closed form of a person at rest: by hand, and against rollouts on ground that moves.
#include "ident/problem/linear_loop.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "ident/problem/behaviour.h"
#include "models/rollout.h"

namespace pushid {
namespace {

ModelOptions Fixed(Delay delay = Delay::kNone) {
  ModelOptions options;
  options.stance = Stance::kFixed;
  options.posture = Posture::kUpright;
  options.delay = delay;
  return options;
}

ParameterSet<double> Gains(double kp, double kd, double delay = 0.0, double passive = 0.0) {
  ParameterSet<double> p{};
  p[kKpTheta] = p[kKpPhi] = kp, p[kKdTheta] = p[kKdPhi] = kd;
  p[kComHeight] = 1.09;
  p[kReactionDelay] = p[kStepDelay] = delay;
  p[kPassiveStiffness] = p[kPassiveDamping] = passive;
  return p;
}

// The reference person: 82.45 kg at 1.0355 m, 101.67 kg m^2; m g h = 837.3 N m/rad. Without a
// delay 1500 N m/rad and 300 N m s/rad are a damped pendulum.
TEST(LinearLoop, WithoutDelayByHand) {
  const double mh = 0.97 * 85.0 * 1.09 * 0.95, inertia = 1.15 * mh * 1.09 * 0.95;
  const double net = 1500.0 - mh * kGravity;
  const LinearLoop loop(Fixed(), Body{}, Gains(1500.0, 300.0), 0);
  const LoopNumbers numbers = loop.Numbers();
  EXPECT_NEAR(numbers.stiffness_ratio, 1500.0 / (mh * kGravity), 1e-6);
  ASSERT_TRUE(numbers.damping_ratio && numbers.natural_hz);
  EXPECT_NEAR(*numbers.natural_hz, std::sqrt(net / inertia) / (2.0 * M_PI), 1e-6);
  EXPECT_NEAR(*numbers.damping_ratio, 300.0 / (2.0 * std::sqrt(net * inertia)), 1e-6);
  // E / x_g = -m h s^2 / (J s^2 + D s + K - m g h).
  const std::complex<double> s(0.0, 2.0 * M_PI * 0.7);
  const std::complex<double> angle = -mh * s * s / (inertia * s * s + 300.0 * s + net);
  const LoopAnswer answer = loop.Answer(Disturbance::kGroundShift, 0.7);
  EXPECT_LT(std::abs(answer.angle - angle), 1e-6 * std::abs(angle));
  const std::complex<double> torque = -(1500.0 + 300.0 * s) * angle;
  EXPECT_LT(std::abs(answer.torque - torque), 1e-6 * std::abs(torque));
}

// L = (K + D s) exp(-s d) / (J s^2 - m g h): at its crossover the margins are what they say.
TEST(LinearLoop, MarginsByHand) {
  const double mh = 0.97 * 85.0 * 1.09 * 0.95, inertia = 1.15 * mh * 1.09 * 0.95;
  const LinearLoop loop(Fixed(Delay::kOne), Body{}, Gains(1300.0, 400.0, 0.1), 0);
  const LoopNumbers numbers = loop.Numbers();
  ASSERT_TRUE(numbers.stable);
  ASSERT_TRUE(numbers.phase_margin && numbers.delay_margin && numbers.crossover_hz);
  const double omega = 2.0 * M_PI * *numbers.crossover_hz;
  const std::complex<double> s(0.0, omega);
  const std::complex<double> gain =
      (1300.0 + 400.0 * s) * std::exp(-0.1 * s) / (inertia * s * s - mh * kGravity);
  EXPECT_NEAR(std::abs(gain), 1.0, 1e-6);
  EXPECT_NEAR(*numbers.phase_margin, std::arg(gain) + M_PI, 1e-6);
  EXPECT_NEAR(*numbers.delay_margin, *numbers.phase_margin / omega, 1e-9);
  // At rest the stiffness must hold the body up.
  ASSERT_TRUE(numbers.gain_down && numbers.gain_up);
  EXPECT_NEAR(*numbers.gain_down, mh * kGravity / 1300.0, 1e-3);
  EXPECT_GT(*numbers.gain_up, 1.0);
}

// Modes of the delayed loop solve its characteristic equation: at the margins of gain and delay the
// fastest one is on the edge.
TEST(LinearLoop, MarginsAreWhereModesStopDecaying) {
  const auto growth = [](double factor, double delay) {
    return LinearLoop(Fixed(Delay::kOne), Body{}, Gains(factor * 1300.0, factor * 400.0, delay), 0)
        .Numbers()
        .fastest_growth;
  };
  const LoopNumbers numbers =
      LinearLoop(Fixed(Delay::kOne), Body{}, Gains(1300.0, 400.0, 0.1), 0).Numbers();
  EXPECT_NEAR(growth(1.0, 0.1 + *numbers.delay_margin), 0.0, 1e-4);
  EXPECT_NEAR(growth(*numbers.gain_up, 0.1), 0.0, 1e-4);
  EXPECT_NEAR(growth(*numbers.gain_down, 0.1), 0.0, 1e-2);
  EXPECT_LT(growth(1.0, 0.1), -0.1);
}

// The settling simulations' own steps, of 1/60 s, lose up to one of them.
TEST(LinearLoop, DelayMarginIsWhereRolloutsBecomeUnstable) {
  Body body{80.0, kReferenceRod, 0.0};
  for (double passive : {0.0, 0.3}) {
    SCOPED_TRACE(passive);
    const double delay = 0.08;
    const LoopNumbers numbers =
        LinearLoop(Fixed(Delay::kOne), body, Gains(1300.0, 400.0, delay, passive), 0).Numbers();
    ASSERT_TRUE(numbers.delay_margin);
    const auto unstable = [&](double more) {
      return ComputeBehaviour(Fixed(Delay::kOne), Gains(1300.0, 400.0, delay + more, passive))
          .unstable();
    };
    EXPECT_TRUE(unstable(*numbers.delay_margin + 0.002));
    EXPECT_FALSE(unstable(*numbers.delay_margin - 1.0 / 60.0));
  }
}

TEST(LinearLoop, UnstableLoopsHaveNoMargins) {
  const LoopNumbers numbers =
      LinearLoop(Fixed(Delay::kOne), Body{}, Gains(1300.0, 400.0, 0.6), 0).Numbers();
  EXPECT_FALSE(numbers.stable);
  EXPECT_FALSE(numbers.phase_margin || numbers.delay_margin || numbers.gain_up);
}

// The oscillation of a series at hz, over whole periods of its end.
std::complex<double> Oscillation(const std::vector<double>& series, double hz, double dt,
                                 int periods) {
  const int frames = static_cast<int>(std::lround(periods / (hz * dt)));
  const int first = static_cast<int>(series.size()) - frames;
  std::complex<double> sum = 0.0;
  for (int t = first; t < first + frames; ++t) {
    sum += series[t] * std::exp(std::complex<double>(0.0, -2.0 * M_PI * hz * t * dt));
  }
  return 2.0 * sum / static_cast<double>(frames);
}

struct RolledOut {
  std::complex<double> angle, torque;
};

// After 20 s on ground that oscillates.
RolledOut RollOut(const ModelOptions& options, const ParameterSet<double>& p, int plane,
                  Disturbance disturbance, double hz, double amplitude, int rate) {
  Scene scene;
  scene.dt = 1.0 / rate;
  scene.people.push_back({Body{}, {}});
  const int frames = static_cast<int>(std::lround(rate * (20.0 + 4.0 / hz))) + 2;
  const auto wave = [&](int t) { return amplitude * std::sin(2.0 * M_PI * hz * t * scene.dt); };
  std::vector<GroundPose> poses(frames, GroundPose::Zero());
  const int row = disturbance == Disturbance::kGroundShift ? plane : 2 + plane;
  for (int t = 0; t < frames; ++t) poses[t][row] = wave(t);
  scene.ground = GroundThrough(poses, scene.dt);
  RolloutPath<double> path;
  EXPECT_TRUE(Rollout<double>(scene, options, {p}, InitialVelocities(scene), frames, &path).ok);
  const BodyOf<double> body =
      DynamicBody<double>(options, Body{}, p, options.stance == Stance::kFixed);
  std::vector<double> angle, torque;
  for (int t = 0; t + 1 < frames; ++t) {
    const PendulumState<double>& state = path.At(t, 0);
    angle.push_back(InLaboratory(scene.ground, t, Vector3<double>::Zero(), state).q[2 + plane]);
    Vector4<double> a = (path.At(t + 1, 0).qd - state.qd) / scene.dt;
    a += scene.ground.StepAt(t).acceleration;
    torque.push_back(InverseDynamics(body, state, a)[2 + plane]);
  }
  const int periods = 3;
  const std::complex<double> input(0.0, -amplitude);  // of sin(omega t)
  return {Oscillation(angle, hz, scene.dt, periods) / input,
          Oscillation(torque, hz, scene.dt, periods) / input};
}

// Gain within 1 %, phase within 1 degree.
void ExpectSame(const std::complex<double>& rolled, const std::complex<double>& closed,
                const char* what) {
  const std::complex<double> ratio = rolled / closed;
  EXPECT_NEAR(std::abs(ratio), 1.0, 0.01) << what;
  EXPECT_NEAR(std::arg(ratio) * 180.0 / M_PI, 0.0, 1.0) << what;
}

struct Case {
  Delay delay;
  double seconds, passive;
};

// Semi-implicit Euler is half a step late with velocities: at 500 Hz gains are off by up to 0.9 %
// and phases by up to 1 degree, at 1000 Hz by half of that.
TEST(LinearLoop, FrequencyResponseIsThatOfRollouts) {
  for (const Case& c :
       {Case{Delay::kNone, 0.0, 0.0}, Case{Delay::kOne, 0.1, 0.0}, Case{Delay::kOne, 0.15, 0.4}}) {
    const ParameterSet<double> p = Gains(1500.0, 400.0, c.seconds, c.passive);
    for (int rate : {500, 1000}) {
      for (double hz : {0.1, 0.5, 1.0, 2.0}) {
        for (Disturbance d : {Disturbance::kGroundShift, Disturbance::kGroundTilt}) {
          const int plane = d == Disturbance::kGroundShift ? 0 : 1;
          SCOPED_TRACE(NameOf(d) + " at " + std::to_string(hz) + " Hz, delay " +
                       std::to_string(c.seconds) + ", rate " + std::to_string(rate));
          const RolledOut rolled = RollOut(Fixed(c.delay), p, plane, d, hz, 1e-4, rate);
          const LoopAnswer closed = LinearLoop(Fixed(c.delay), Body{}, p, plane).Answer(d, hz);
          ExpectSame(rolled.angle, closed.angle, "angle");
          ExpectSame(rolled.torque, closed.torque, "torque");
        }
      }
    }
  }
}

// A cart that is free: with drag, a cross term and late steps.
TEST(LinearLoop, SlidingFeetToo) {
  ModelOptions options;
  options.posture = Posture::kUpright;
  ParameterSet<double> p = Gains(2500.0, 300.0, 0.05, 0.2);
  p[kMu] = 200.0, p[kAx] = p[kAy] = -4.0, p[kTx] = p[kTy] = -0.3;
  for (Delay delay : {Delay::kNone, Delay::kAnkleAndStep}) {
    options.delay = delay;
    for (int plane : {0, 1}) {
      const LinearLoop loop(options, Body{}, p, plane);
      ASSERT_TRUE(loop.Numbers().stable);
      const RolledOut rolled =
          RollOut(options, p, plane, Disturbance::kGroundShift, 0.8, 1e-4, 1000);
      const LoopAnswer closed = loop.Answer(Disturbance::kGroundShift, 0.8);
      ExpectSame(rolled.angle, closed.angle, "angle");
      ExpectSame(rolled.torque, closed.torque, "torque");
    }
  }
}

// The cart's velocity is felt by the ankles as late as all else, in rollouts, here and in the
// modes of their steps.
TEST(LinearLoop, ModesAreThoseOfSteps) {
  ModelOptions options;
  options.posture = Posture::kUpright;
  options.delay = Delay::kOne;
  ParameterSet<double> p = Gains(1300.0, 300.0, 0.15);
  p[kMu] = 60.0, p[kAx] = p[kAy] = -4.0, p[kTx] = p[kTy] = -0.5;
  const Body body{80.0, kReferenceRod, 0.0};
  const double growth = LinearLoop(options, body, p, 0).Numbers().fastest_growth;
  EXPECT_NEAR(ComputeBehaviour(options, p).fastest_growth, growth, 0.05 * std::abs(growth));
}

// On ground that accelerates people cannot tell it from ground that is tilted: -g sin and g cos are
// what both feel.
TEST(LinearLoop, ConstantAccelerationIsTiltedGravity) {
  constexpr int kFrames = 600;
  constexpr double kTilt = 0.05;
  Scene tilted;
  tilted.dt = 1.0 / 100.0;
  tilted.people.push_back({Body{}, {}});
  Scene shifted = tilted;
  GroundPose lean = GroundPose::Zero();
  lean[2] = kTilt;
  tilted.ground = GroundThrough(std::vector<GroundPose>(kFrames, lean), tilted.dt);
  std::vector<GroundPose> poses(kFrames, GroundPose::Zero());
  const double a = -kGravity * std::sin(kTilt);
  for (int t = 0; t < kFrames; ++t) poses[t][0] = 0.5 * a * t * (t + 1.0) * tilted.dt * tilted.dt;
  shifted.ground = GroundThrough(poses, tilted.dt);
  for (GroundStep& step : shifted.ground.steps) step.gravity = kGravity * std::cos(kTilt);
  RolloutPath<double> on_tilted, on_shifted;
  const ParameterSet<double> p = Gains(1500.0, 300.0);
  for (auto& [scene, path] : {std::pair(&tilted, &on_tilted), std::pair(&shifted, &on_shifted)}) {
    ASSERT_TRUE(Rollout<double>(*scene, Fixed(), {p}, InitialVelocities(*scene), kFrames, path).ok);
  }
  double largest = 0.0;
  for (int t = 0; t < kFrames; ++t) {
    largest = std::max(largest, std::abs(on_tilted.At(t, 0).q[2]));
    EXPECT_NEAR(on_tilted.At(t, 0).q[2], on_shifted.At(t, 0).q[2], 1e-10);
  }
  EXPECT_GT(largest, 0.03);
  // In the end they lean as the effective gravity does, less what it takes to hold them there.
  const double mgh = 0.97 * 85.0 * 1.09 * 0.95 * kGravity;
  const double end = on_tilted.At(kFrames - 1, 0).q[2];
  EXPECT_NEAR(1500.0 * end, mgh * std::sin(kTilt + end), 0.01 * mgh * kTilt);
}

}  // namespace
}  // namespace pushid
