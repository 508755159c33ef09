// Waves of trajectories whose speed is known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "datasets/files/random.h"
#include "ident/formations/formation_run.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

constexpr double kWaveRate = 50.0, kSpacing = 0.5, kSpeed = 1.25;

// People in a line, the last of them first to move: each goes 0.3 m at 1 m/s from its onset on.
PointMotion WaveLine(int people, double noise) {
  Random random(7);
  PointMotion motion;
  motion.rate_hz = kWaveRate;
  motion.unit = LengthUnit::kMetre;
  for (int n = 0; n < people; ++n) {
    motion.names.push_back("p" + std::to_string(n));
    motion.positions.emplace_back();
    const double onset = 0.2 + n * kSpacing / kSpeed;
    for (int frame = 0; frame < 200; ++frame) {
      const double moved = std::clamp(frame / kWaveRate - onset, 0.0, 0.3);
      motion.positions.back().push_back(
          {n * kSpacing + moved + noise * random.Normal(), noise * random.Normal(), 1.0});
    }
  }
  ChoosePoints({}, &motion);
  return motion;
}

TEST(MeasuredWave, FindsTheSpeedOfALine) {
  const MeasuredWave wave = MeasureWave("line", WaveLine(6, 0.0));
  ASSERT_EQ(wave.people.size(), 6u);
  EXPECT_EQ(wave.people[0].name, "p0");
  EXPECT_NEAR(wave.people[5].distance, 5 * kSpacing, 1e-9);
  EXPECT_NEAR(wave.people[3].peak_speed, 1.0, 1e-6);
  EXPECT_NEAR(wave.people[3].displaced, 0.3, 1e-9);
  ASSERT_TRUE(wave.slowness);
  EXPECT_NEAR(1.0 / *wave.slowness, kSpeed, 0.03);  // onsets are whole frames
}

TEST(MeasuredWave, HoldsTheSpeedWithinItsInterval) {
  const MeasuredWave wave = MeasureWave("line", WaveLine(6, 0.002));
  ASSERT_TRUE(wave.slowness);
  EXPECT_LE(std::abs(*wave.slowness - 1.0 / kSpeed), wave.quantile * wave.error);
}

// People who are not seen in the first frames, or not at all.
TEST(MeasuredWave, PeopleMayBeMissing) {
  PointMotion motion = WaveLine(6, 0.0);
  const Eigen::Vector3d none = Eigen::Vector3d::Constant(std::nan(""));
  for (int frame = 0; frame < 5; ++frame) motion.positions[2][frame] = none;
  motion.positions[4].assign(200, none);
  const MeasuredWave wave = MeasureWave("line", motion);
  ASSERT_EQ(wave.people.size(), 5u);
  EXPECT_NEAR(1.0 / *wave.slowness, kSpeed, 0.03);
}

TEST(MeasuredWave, TwoWhoMoveHaveNoSpeed) {
  EXPECT_FALSE(MeasureWave("pair", WaveLine(2, 0.0)).slowness);
  EXPECT_TRUE(Contains(WaveText(MeasureWave("pair", WaveLine(2, 0.0))), "fewer than three"));
  PointMotion still = WaveLine(3, 0.0);
  for (auto& track : still.positions) track.assign(200, track[0]);
  EXPECT_TRUE(Contains(WaveText(MeasureWave("still", still)), "nobody moves"));
}

TEST(MeasuredWave, SeveralHaveTheIntervalOfTheirScatter) {
  const MeasuredWave a = MeasureWave("a", WaveLine(6, 0.0)),
                     b = MeasureWave("b", WaveLine(5, 0.003));
  EXPECT_EQ(WavesText({a}), "");
  EXPECT_TRUE(Contains(WavesText({a, b}), "speed of the onset, 2 recordings: "));
}

class MeasuredWaveFiles : public TempDirTest {};

TEST_F(MeasuredWaveFiles, MarkersOfABodyAreNoCrowd) {
  EXPECT_TRUE(Contains(ProblemOf(MeasureWaves(WriteText("walk.trc", "PathFileType 4"))),
                       "one point a person"));
}

}  // namespace
}  // namespace pushid
