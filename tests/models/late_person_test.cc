// People whose feet hold and who answer late, on ground that moves, against plain code of its own:
// continuous time, Runge-Kutta of fourth order at 0.1 ms, the delay by a history of what was.
// Rollouts come to it as their steps get shorter.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "models/rollout.h"

namespace pushid {
namespace {

// The person of 80 kg and 0.9 m; torques in N m about the ankles.
struct LatePerson {
  double mass = 80.0, rod = 0.9, stiffness = 1400.0, damping = 350.0, share = 0.3, delay = 0.12;

  double Scale() const { return mass / 85.0 * rod / 0.95; }
  double Inertia() const { return 1.15 * 0.97 * mass * std::pow(1.09 * rod, 2); }

  // The lean's acceleration; ground: m/s^2; tilt: of the ground, rad, and turn its second
  // derivative.
  double Acceleration(double lean, double rate, double then, double rate_then, double push,
                      double ground, double tilt, double turn) const {
    const double k = stiffness * Scale(), d = damping * Scale() * rod / 0.95;
    const double torque =
        -(1.0 - share) * (k * then + d * rate_then) - share * (k * lean + d * rate);
    const double moment = 0.97 * mass * 1.09 * rod;
    const double load = moment * (9.81 * std::sin(lean + tilt) - ground * std::cos(lean));
    return (load + torque + push * rod) / Inertia() - turn;
  }
};

using OfTime = std::function<double(double)>;

// Leans at multiples of `step`, s.
std::vector<double> Simulated(const LatePerson& p, const OfTime& push, const OfTime& ground,
                              const OfTime& tilt, const OfTime& turn, double seconds, double step) {
  constexpr double kStep = 1e-4;
  std::vector<double> leans = {0.0}, rates = {0.0};
  const auto back = [&](const std::vector<double>& past, double at) {
    const double k = (at - p.delay) / kStep;
    if (k <= 0.0) return 0.0;
    const size_t i = std::min(static_cast<size_t>(k), past.size() - 1);
    const size_t next = std::min(i + 1, past.size() - 1);
    return past[i] + (k - static_cast<double>(i)) * (past[next] - past[i]);
  };
  const int steps = static_cast<int>(std::lround(seconds / kStep));
  for (int n = 0; n < steps; ++n) {
    const double t = n * kStep, lean = leans.back(), rate = rates.back();
    const auto slope = [&](double ahead, double l, double r) {
      const double s = t + ahead;
      return p.Acceleration(l, r, back(leans, s), back(rates, s), push(s), ground(s), tilt(s),
                            turn(s));
    };
    const double h = kStep;
    const double a1 = slope(0.0, lean, rate), r2 = rate + h / 2 * a1;
    const double a2 = slope(h / 2, lean + h / 2 * rate, r2), r3 = rate + h / 2 * a2;
    const double a3 = slope(h / 2, lean + h / 2 * r2, r3), r4 = rate + h * a3;
    const double a4 = slope(h, lean + h * r3, r4);
    leans.push_back(lean + h / 6 * (rate + 2 * r2 + 2 * r3 + r4));
    rates.push_back(rate + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4));
  }
  std::vector<double> at_frames;
  for (int t = 0; t * step <= seconds + 1e-9; ++t) {
    at_frames.push_back(leans[static_cast<size_t>(std::lround(t * step / kStep))]);
  }
  return at_frames;
}

struct Trial {
  const char* name;
  double push, shift, tilt, delay;
};

class LatePeople : public testing::TestWithParam<Trial> {};

TEST_P(LatePeople, RolloutsComeToTheContinuousOnes) {
  const Trial& trial = GetParam();
  LatePerson person;
  person.delay = trial.delay;
  constexpr double kSeconds = 1.5, kOmega = 4.0;
  // From rest, smoothly.
  const auto begin = [](double t) { return 1.0 - std::exp(-t * t / 0.04); };
  const OfTime push = [&](double t) {
    return t < 0.3 ? trial.push * std::pow(std::sin(M_PI * t / 0.3), 2) : 0.0;
  };
  const auto moved = [&](double t) { return begin(t) * std::sin(kOmega * t); };
  const auto curve = [&](double t) {
    constexpr double kDifference = 1e-4;
    return (moved(t + kDifference) - 2.0 * moved(t) + moved(t - kDifference)) /
           (kDifference * kDifference);
  };
  const OfTime ground = [&](double t) { return trial.shift * curve(t); };
  const OfTime tilt = [&](double t) { return trial.tilt * moved(t); };
  const OfTime turn = [&](double t) { return trial.tilt * curve(t); };

  ModelOptions options;
  options.stance = Stance::kFixed;
  options.delay = trial.delay > 0.0 ? Delay::kOne : Delay::kNone;
  options.push_tail = PushTail::kNone;
  ParameterSet<double> p{};
  p[kKpTheta] = p[kKpPhi] = person.stiffness;
  p[kKdTheta] = p[kKdPhi] = person.damping;
  p[kReactionDelay] = person.delay;
  p[kPassiveStiffness] = p[kPassiveDamping] = person.share;
  p[kComHeight] = 1.09;

  std::vector<double> errors;
  double largest = 0.0;
  for (double fps : {50.0, 100.0, 200.0, 400.0}) {
    Scene scene;
    scene.dt = 1.0 / fps;
    scene.people = {{{person.mass, person.rod, 0.0}, {}}};
    const int frames = static_cast<int>(std::lround(kSeconds * fps)) + 1;
    std::vector<Vector4<double>> rows;
    std::vector<GroundPose> poses;
    for (int t = 0; t < frames; ++t) {
      rows.push_back({push(t / fps), 0.0, push(t / fps) * person.rod, 0.0});
      poses.push_back({trial.shift * moved(t / fps), 0.0, trial.tilt * moved(t / fps), 0.0});
    }
    scene.pushes = {MakeScenePush(0, 0, PushKind::kExternal, rows)};
    if (trial.shift != 0.0 || trial.tilt != 0.0) scene.ground = GroundThrough(poses, scene.dt);
    RolloutPath<double> path;
    ASSERT_TRUE(Rollout<double>(scene, options, {p}, InitialVelocities(scene), frames, &path).ok);
    const std::vector<double> truth =
        Simulated(person, push, ground, tilt, turn, kSeconds, scene.dt);
    double worst = 0.0;
    for (int t = 0; t < frames; ++t) {
      worst = std::max(worst, std::abs(path.At(t, 0).q[2] - truth[t]));
      largest = std::max(largest, std::abs(truth[t]));
    }
    errors.push_back(worst);
  }
  EXPECT_GT(largest, 0.01);
  EXPECT_LT(errors.back(), 0.02 * largest);
  // Errors are of first order: half the step, half the error.
  for (size_t i = 1; i < errors.size(); ++i) {
    EXPECT_LT(errors[i], 0.65 * errors[i - 1]) << i << ": " << errors[i - 1] << " " << errors[i];
  }
}

INSTANTIATE_TEST_SUITE_P(Trials, LatePeople,
                         testing::Values(Trial{"push", 120.0, 0.0, 0.0, 0.0},
                                         Trial{"late_push", 120.0, 0.0, 0.0, 0.12},
                                         Trial{"late_on_shifted_ground", 0.0, 0.03, 0.0, 0.12},
                                         Trial{"late_on_tilted_ground", 0.0, 0.0, 0.03, 0.12},
                                         Trial{"all_of_it", 60.0, 0.02, 0.02, 0.15}),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace pushid
