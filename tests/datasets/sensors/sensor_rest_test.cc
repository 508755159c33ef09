// The zero of a load cell, from its record before the pull.
#include <gtest/gtest.h>

#include <cmath>

#include "datasets/files/random.h"
#include "datasets/sensors/force_sensors.h"

namespace pushid {
namespace {

// 60 N for 0.3 s from `begin` on, at 1 kHz for 2 s, on a reading at rest.
SensorRecord Pull(double begin, double rest, double noise) {
  Random random(3);
  SensorRecord record;
  for (int i = 0; i < 2000; ++i) {
    const double t = 1e-3 * i, phase = (t - begin) / 0.3;
    const double pull = phase > 0.0 && phase < 1.0 ? 60.0 * std::sin(M_PI * phase) : 0.0;
    record.time_s.push_back(t);
    record.force.push_back({pull + rest + noise * random.Normal(), 0.0, 0.0});
  }
  return record;
}

double Impulse(const SensorRecord& record) {
  double sum = 0.0;
  for (const Eigen::Vector3d& force : record.force) sum += 1e-3 * force.x();
  return sum;
}

TEST(SubtractRest, AReadingIsNoPull) {
  for (double noise : {0.0, 0.5, 2.0}) {
    SensorRecord record = Pull(0.5, 2.3, noise);
    const double exact = Impulse(Pull(0.5, 0.0, noise));
    EXPECT_NEAR(Impulse(record) - exact, 4.6, 1e-9);
    SubtractRest(&record);
    EXPECT_NEAR(record.subtracted.x(), 2.3, 0.2) << noise;
    EXPECT_NEAR(record.noise, noise, 0.1 * noise) << noise;
    EXPECT_NEAR(Impulse(record), exact, 0.4) << noise;
  }
}

TEST(SubtractRest, NothingIsSubtractedWhereNothingIsRead) {
  SensorRecord record = Pull(0.5, 0.0, 1.0);
  const double before = Impulse(record);
  SubtractRest(&record);
  EXPECT_EQ(Impulse(record), before);
  EXPECT_NEAR(record.noise, 1.0, 0.1);  // it is known all the same
}

// A record that begins with the pull, and a load that was there before.
TEST(SubtractRest, WhatMayBeAForceIsKept) {
  SensorRecord record = Pull(-0.1, 2.3, 0.1);
  SubtractRest(&record);
  EXPECT_EQ(record.subtracted.x(), 0.0);
  record = Pull(0.5, 40.0, 0.1);
  SubtractRest(&record);
  EXPECT_EQ(record.subtracted.x(), 0.0);
}

}  // namespace
}  // namespace pushid
