// The offset between force and motion: recovered from rollouts of the model with a known shift.
#include <gtest/gtest.h>

#include <cmath>

#include "datasets/files/random.h"
#include "datasets/synthetic/synthetic_recordings.h"
#include "ident/push/push_estimation.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

struct PushedRecording {
  PendulumRecording recording;
  TimedRecord force;  // whose clock reads `shift` more at frame 0 than it says
};

// A person pushed by a measured half-sine, and the record of the sensor: the rows' forces at 1 kHz.
PushedRecording MakePushed(double shift_s, double noise_m, uint64_t seed) {
  SyntheticOptions options;
  options.subjects = 1;
  options.recordings_per_subject = 1;
  options.frames = 90;
  options.push_kind = PushKind::kExternal;
  options.push_start_frame = 15;
  options.model.push_tail = PushTail::kNone;
  options.joint_noise_m = noise_m;
  options.direction_sigma_rad = 0.0;
  options.seed = 4;
  options.noise_seed = seed;
  const auto made = Unwrapped(MakeSyntheticRecordings(options));
  const Recording& recording = made[0].recording;
  PushedRecording pushed;
  pushed.recording = MakePendulumRecording(recording);
  const Push& push = recording.pushes[0];
  for (int i = 0; i < 1500; ++i) {
    const double t = i / 1000.0;
    const int row = static_cast<int>(std::floor(t * recording.fps)) - push.start_frame;
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
    if (row >= 0 && row < static_cast<int>(push.force.size())) {
      force.head<2>() = push.force[row].head<2>();
    }
    pushed.force.record.time_s.push_back(t + shift_s);
    pushed.force.record.force.push_back(force);
  }
  pushed.force.record.is_vector = true;
  return pushed;
}

TEST(SensorOffsetTest, FoundWithoutNoise) {
  for (double shift : {0.0, 0.1234, -0.2}) {
    const PushedRecording pushed = MakePushed(shift, 0.0, 1);
    const auto offset = Unwrapped(EstimateSensorOffset({pushed.force}, pushed.recording, 0, 0.5));
    // Half a frame is what semi-implicit steps leave open.
    EXPECT_NEAR(offset.offset_s, shift, 0.6 / 60.0);
  }
}

// What the shift changes is recovered exactly: the bias of the steps is the same.
TEST(SensorOffsetTest, ShiftsAddUp) {
  const PushedRecording a = MakePushed(0.0, 0.0, 1), b = MakePushed(0.15, 0.0, 1);
  const double first = EstimateSensorOffset({a.force}, a.recording, 0, 0.5).value().offset_s;
  const double second = EstimateSensorOffset({b.force}, b.recording, 0, 0.5).value().offset_s;
  EXPECT_NEAR(second - first, 0.15, 1e-5);
  // And with the clock set, nothing is left to shift.
  TimedRecord set = b.force;
  set.frame_zero_time_s = 0.15;
  EXPECT_NEAR(EstimateSensorOffset({set}, b.recording, 0, 0.5).value().offset_s, first, 1e-5);
}

TEST(SensorOffsetTest, TheErrorIsThatOfTheNoise) {
  const double clean = [] {
    const PushedRecording pushed = MakePushed(0.1, 0.0, 1);
    return EstimateSensorOffset({pushed.force}, pushed.recording, 0, 0.5).value().offset_s;
  }();
  double square = 0.0, stated = 0.0;
  constexpr int kSeeds = 60;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const PushedRecording pushed = MakePushed(0.1, 0.002, seed);
    const auto offset = Unwrapped(EstimateSensorOffset({pushed.force}, pushed.recording, 0, 0.5));
    square += std::pow(offset.offset_s - clean, 2) / kSeeds;
    stated += offset.standard_error_s / kSeeds;
  }
  EXPECT_LT(std::sqrt(square), 0.01);
  EXPECT_GT(stated, 0.5 * std::sqrt(square));
  EXPECT_LT(stated, 2.0 * std::sqrt(square));
}

TEST(SensorOffsetTest, TwoSensorsShareTheClock) {
  PushedRecording pushed = MakePushed(0.1, 0.0, 1);
  const double together =
      EstimateSensorOffset({pushed.force}, pushed.recording, 0, 0.5).value().offset_s;
  for (Eigen::Vector3d& force : pushed.force.record.force) force *= 0.5;
  const auto halves = EstimateSensorOffset({pushed.force, pushed.force}, pushed.recording, 0, 0.5);
  EXPECT_NEAR(halves.value().offset_s, together, 1e-9);
}

TEST(SensorOffsetTest, Errors) {
  PushedRecording pushed = MakePushed(0.3, 0.0, 1);
  const auto message = [&](int person, double range) {
    return ProblemOf(EstimateSensorOffset({pushed.force}, pushed.recording, person, range));
  };
  EXPECT_TRUE(Contains(message(0, 0.1), "do not fit together within 0.1 s"));
  EXPECT_TRUE(Contains(message(1, 0.5), "there is no person 1"));
  EXPECT_TRUE(Contains(message(0, 0.0), "largest offset"));
  const auto times = [&](double factor) {
    PushedRecording scaled = pushed;
    for (Eigen::Vector3d& force : scaled.force.record.force) force *= factor;
    return EstimateSensorOffset({scaled.force}, pushed.recording, 0, 0.5);
  };
  EXPECT_NEAR(times(1.0).value().gain, 1.0, 0.02);
  EXPECT_TRUE(Contains(times(0.001).error().ToString(), "the sensor's time cannot be found"));
  EXPECT_TRUE(Contains(times(-1.0).error().ToString(), "against the force"));
  PushedRecording stands = pushed;
  stands.recording.steps.assign(1, PersonSteps());
  EXPECT_TRUE(
      Contains(EstimateSensorOffset({stands.force}, stands.recording, 0, 0.5).error().ToString(),
               "the feet do not move"));
  for (Eigen::Vector3d& force : pushed.force.record.force) force = {0.0, 0.0, 700.0};
  EXPECT_TRUE(Contains(message(0, 0.5), "no horizontal force"));
}

}  // namespace
}  // namespace pushid
