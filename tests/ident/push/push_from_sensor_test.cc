// External pushes from force sensors: impulse kept, direction and contact height honoured.
#include <gtest/gtest.h>

#include <cmath>

#include "datasets/synthetic/synthetic_recordings.h"
#include "ident/push/push_estimation.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

PendulumRecording StandingPerson() {
  SyntheticOptions options;
  options.strengths = {{"none", 0.0}};
  return MakePendulumRecording(MakeSyntheticRecordings(options).value()[0].recording);
}

// A half-sine of 300 N from 0.213 s on, 0.11 s long, sampled every `step` s with some jitter.
SensorRecord HalfSine(double step, bool is_vector = false) {
  SensorRecord record;
  record.file = "sensor.csv";
  record.is_vector = is_vector;
  for (int i = 0; i * step < 0.6; ++i) {
    const double time = (i + 0.3 * std::sin(1.7 * i)) * step;
    const double phase = (time - 0.213) / 0.11;
    const double force = phase > 0.0 && phase < 1.0 ? 300.0 * std::sin(M_PI * phase) : 0.0;
    record.time_s.push_back(time);
    record.force.push_back(is_vector ? Vector3<double>(0.6 * force, -0.3 * force, 0.2 * force)
                                     : Vector3<double>(force, 0.0, 0.0));
  }
  return record;
}

Vector3<double> TrapezoidImpulse(const SensorRecord& record) {
  Vector3<double> sum = Vector3<double>::Zero();
  for (int i = 1; i < record.num_samples(); ++i) {
    sum +=
        0.5 * (record.time_s[i] - record.time_s[i - 1]) * (record.force[i] + record.force[i - 1]);
  }
  return sum;
}

Vector4<double> Impulse(const Push& push, double dt) {
  Vector4<double> sum = Vector4<double>::Zero();
  for (const Vector4<double>& row : push.force) sum += dt * row;
  return sum;
}

TEST(PushFromSensor, KeepsTheImpulseAtAnySamplingRate) {
  const PendulumRecording recording = StandingPerson();
  for (double step : {1e-4, 1e-3, 0.0101, 1.0 / 60.0, 0.04}) {
    const SensorRecord record = HalfSine(step);
    SensorChoice options;
    options.direction = {3.0, -4.0, 0.0};
    const Push push = Unwrapped(PushFromSensor(record, options, recording, 0));
    const double expected = TrapezoidImpulse(record).x();
    const Vector4<double> impulse = Impulse(push, recording.scene.dt);
    EXPECT_NEAR(impulse[0], 0.6 * expected, 1e-11);
    EXPECT_NEAR(impulse[1], -0.8 * expected, 1e-11);
    if (step < 0.01) {
      EXPECT_NEAR(expected, 300.0 * 0.11 * 2.0 / M_PI, 0.05);
      EXPECT_EQ(push.start_frame, 13);  // 0.213 s, nearest to its 12.8
      EXPECT_EQ(push.EndFrame(), 20);   // 0.323 s
    }
  }
}

// A mass that the half-sine pushes, in closed form, against the same mass stepped as people are:
// where it is afterwards is wrong by a quarter at most with frames half as long.
TEST(PushFromSensor, PositionsAreOfSecondOrder) {
  constexpr double kBegin = 0.213, kSeconds = 0.11, kPeak = 300.0, kMass = 80.0;
  const SensorRecord record = HalfSine(1e-4);
  double error[2] = {0.0, 0.0};
  for (int i = 0; i < 2; ++i) {
    SyntheticOptions options;
    options.strengths = {{"none", 0.0}};
    options.fps = i == 0 ? 30.0 : 60.0;
    options.frames = i == 0 ? 31 : 61;
    // The mean of both signs: where in a frame a push begins is not of any order.
    for (int shift = 0; shift < 20; ++shift) {
      const PendulumRecording recording =
          MakePendulumRecording(MakeSyntheticRecordings(options).value()[0].recording);
      SensorChoice given;
      given.start_s = -0.005 * shift;
      const Push push = Unwrapped(PushFromSensor(record, given, recording, 0));
      const double dt = recording.scene.dt;
      double x = 0.0, v = 0.0;
      for (int t = 0; t + 1 < recording.num_frames(); ++t) {
        const int row = t - push.start_frame;
        const bool pushed = row >= 0 && row < static_cast<int>(push.force.size());
        v += pushed ? dt * push.force[row][0] / kMass : 0.0;
        x += dt * v;
      }
      const double end = (recording.num_frames() - 1) * dt;
      const double middle = kBegin + 0.005 * shift + 0.5 * kSeconds;
      const double impulse = kPeak * kSeconds * 2.0 / M_PI;
      error[i] += std::abs(x - impulse / kMass * (end - middle)) / 20.0;
    }
  }
  // Half a frame early would be impulse / mass * dt / 2: 4.4 mm at 30 frames per second.
  EXPECT_LT(error[0], 1e-4);
  EXPECT_LT(error[1], 0.35 * error[0] + 1e-6);
}

TEST(PushFromSensor, RowsAreTheForceAtItsPoint) {
  const PendulumRecording recording = StandingPerson();
  const SensorRecord record = HalfSine(1e-3, true);
  const Body& body = recording.scene.people[0].body;
  for (bool in_metres : {false, true}) {
    SensorChoice options;
    options.height_fraction = 1.25;
    options.direction.setZero();  // not used: the record has its own
    const Vector4<double>& start = recording.states[0][12].q;
    if (in_metres) {
      options.height_m =
          body.cart_height + 1.25 * (HipPosition(body, start).z() - body.cart_height);
      options.height_fraction = 0.0;
    }
    const Push push = Unwrapped(PushFromSensor(record, options, recording, 0));
    for (int i = 0; i < static_cast<int>(push.force.size()); ++i) {
      const Vector4<double>& row = push.force[i];
      const double size = row[0] / 0.6;
      const Vector4<double> expected =
          GeneralizedForce<double>(body, recording.states[0][push.start_frame + i].q,
                                   {0.6 * size, -0.3 * size, 0.2 * size}, 1.25);
      EXPECT_LT((row - expected).norm(), 1e-9) << i;
    }
  }
}

TEST(PushFromSensor, ClockAndIdlingAreHonoured) {
  const PendulumRecording recording = StandingPerson();
  SensorRecord record = HalfSine(1e-3);
  for (double& time : record.time_s) time += 1000.0;
  SensorChoice options;
  options.start_s = 1000.1;
  for (int i = 0; i < record.num_samples(); ++i) record.force[i].x() += i % 2 ? 4.0 : -2.0;
  options.idle_force = 5.0;
  const Push push = Unwrapped(PushFromSensor(record, options, recording, 0));
  // 0.113 s, nearest to frame 7.
  EXPECT_EQ(push.start_frame, 7);
  EXPECT_EQ(push.EndFrame(), 14);
  EXPECT_EQ(push.file, "sensor.csv");
}

// Noise before and after it is no push, whose end what follows (constant velocity, tail) begins at.
TEST(PushFromSensor, NoiseIsNoPush) {
  const PendulumRecording recording = StandingPerson();
  SensorRecord record = HalfSine(1e-3);
  const Result<Push> clean = PushFromSensor(record, {}, recording, 0);
  for (int i = 0; i < record.num_samples(); ++i) record.force[i].x() += 0.5 * std::sin(0.7 * i * i);
  const Push noisy = Unwrapped(PushFromSensor(record, {}, recording, 0));
  EXPECT_NEAR(noisy.start_frame, clean.value().start_frame, 1);
  EXPECT_NEAR(noisy.EndFrame(), clean.value().EndFrame(), 1);
}

TEST(PushFromSensor, UnsoundInputsAreErrors) {
  const PendulumRecording recording = StandingPerson();
  const SensorRecord record = HalfSine(1e-3);
  const auto problem = [&](const SensorRecord& r, const SensorChoice& options, int person = 0) {
    return ProblemOf(PushFromSensor(r, options, recording, person));
  };
  SensorChoice options;
  EXPECT_EQ(problem(record, options), "no error");
  options.direction.setZero();
  EXPECT_TRUE(Contains(problem(record, options), "direction"));
  options = {};
  EXPECT_TRUE(Contains(problem(record, options, 2), "no person 2"));
  options = {};
  options.height_m = NAN;
  EXPECT_TRUE(Contains(problem(record, options), "contact height"));
  options = {};
  options.start_s = 0.26;  // half of the push happens before
  EXPECT_TRUE(Contains(problem(record, options), "sensor.csv: "));
  EXPECT_TRUE(Contains(problem(record, options), "outside recording"));
  EXPECT_TRUE(Contains(problem(record, options), "frame 0 is at 0.26 s of the sensor's clock"));
  SensorRecord resting = record;  // it never reads nothing
  for (Vector3<double>& force : resting.force) force.x() += 30.0;
  EXPECT_TRUE(
      Contains(problem(resting, options), "what it reads at rest (zero, in a list of sensors)"));
  options.start_s = 5.0;  // all of it
  EXPECT_TRUE(Contains(problem(record, options), "outside recording"));
  options = {};
  options.idle_force = 1000.0;
  EXPECT_TRUE(Contains(problem(record, options), "no force greater than"));
  SensorRecord silent = record;
  for (Vector3<double>& force : silent.force) force.setZero();
  EXPECT_TRUE(Contains(problem(silent, {}), "no force greater than"));
}

}  // namespace
}  // namespace pushid
