// Gaps, low-pass and resampling: hand-made cases and properties.
#include <gtest/gtest.h>

#include <cmath>

#include "datasets/files/random.h"
#include "datasets/loading/motion_tracks.h"
#include "datasets/loading/pendulum_recording.h"
#include "tests/datasets/points_folder.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

using Track = std::vector<Eigen::Vector3d>;

Track Cubic(int frames) {
  Track track;
  for (int t = 0; t < frames; ++t) track.push_back({1.0 * t, 3.0 - 0.5 * t, 2.0});
  return track;
}

TEST(TrackGapsTest, StraightMotionIsRestoredExactly) {
  const Track truth = Cubic(20);
  Track track = truth;
  for (int t : {3, 4, 5, 11}) track[t] = kHidden;
  std::vector<double> weight(20, 1.0);
  const GapCount count = FillGaps(3, &track, &weight);
  EXPECT_EQ(count.gaps, 2);
  EXPECT_EQ(count.excluded_frames, 0);
  for (int t = 0; t < 20; ++t) {
    EXPECT_LT((track[t] - truth[t]).norm(), 1e-12) << t;
    EXPECT_EQ(weight[t], 1.0);
  }
}

TEST(TrackGapsTest, CurvesAreFollowedBetterThanByALine) {
  Track track, truth;
  for (int t = 0; t < 30; ++t) truth.push_back({std::sin(0.2 * t), std::cos(0.2 * t), 0.0});
  track = truth;
  for (int t = 10; t < 16; ++t) track[t] = kHidden;
  Track line = track;
  std::vector<double> weight(30, 1.0);
  FillGaps(10, &track, &weight);
  FillGaps(0, &line, &weight);
  EXPECT_LT((track[12] - truth[12]).norm(), 0.25 * (line[12] - truth[12]).norm());
}

TEST(TrackGapsTest, LongGapsAndEndsLoseTheirWeight) {
  Track track = Cubic(12);
  for (int t : {0, 1, 5, 6, 7, 11}) track[t] = kHidden;
  std::vector<double> weight(12, 1.0);
  const GapCount count = FillGaps(2, &track, &weight);
  EXPECT_EQ(count.gaps, 3);
  EXPECT_EQ(count.excluded_frames, 6);
  EXPECT_EQ(weight, (std::vector<double>{0, 0, 1, 1, 1, 0, 0, 0, 1, 1, 1, 0}));
  EXPECT_EQ(track[0], track[2]);
  EXPECT_EQ(track[11], track[10]);
  for (const Eigen::Vector3d& position : track) EXPECT_TRUE(position.allFinite());
}

TEST(TrackGapsTest, NeverSeen) {
  Track track(5, kHidden);
  std::vector<double> weight(5, 1.0);
  EXPECT_EQ(FillGaps(10, &track, &weight).excluded_frames, 5);
  EXPECT_EQ(weight, std::vector<double>(5, 0.0));
  EXPECT_FALSE(track[0].allFinite());
}

// The amplitude that the filter leaves of a sine of one frequency.
double Gain(double hz, double cutoff_hz, double rate_hz) {
  Track track;
  const int frames = static_cast<int>(20.0 * rate_hz);
  for (int t = 0; t < frames; ++t) {
    track.push_back({std::sin(2.0 * M_PI * hz * t / rate_hz), 0.0, 0.0});
  }
  LowPass(cutoff_hz, rate_hz, &track);
  double in_phase = 0.0, out_of_phase = 0.0, power = 0.0;  // in the middle
  for (int t = frames / 4; t < 3 * frames / 4; ++t) {
    const double phase = 2.0 * M_PI * hz * t / rate_hz;
    in_phase += track[t].x() * std::sin(phase);
    out_of_phase += track[t].x() * std::cos(phase);
    power += std::sin(phase) * std::sin(phase);
  }
  EXPECT_NEAR(out_of_phase / power, 0.0, 1e-3) << "not zero phase at " << hz << " Hz";
  return in_phase / power;
}

// |H|^2 of a pass is 1 / (1 + (w / w_1)^4) with w = tan(pi f / rate), and the two together have
// lost 3 dB at the cut-off, also where the bilinear transform bends the frequencies.
TEST(LowPassTest, FrequencyResponse) {
  for (double rate : {60.0, 120.0, 1000.0}) {
    for (double hz : {0.5, 3.0, 6.0, 12.0, 20.0}) {
      const double ratio = std::tan(M_PI * hz / rate) / std::tan(M_PI * 6.0 / rate);
      EXPECT_NEAR(Gain(hz, 6.0, rate), 1.0 / (1.0 + (std::sqrt(2.0) - 1.0) * std::pow(ratio, 4)),
                  2e-3)
          << hz << " Hz at " << rate;
    }
    for (double cutoff : {3.0, 6.0, 12.0, 20.0}) {
      EXPECT_NEAR(Gain(cutoff, cutoff, rate), std::sqrt(0.5), 2e-3) << cutoff << " at " << rate;
    }
  }
}

TEST(LowPassTest, StraightMotionStaysToTheEnds) {
  const Track truth = Cubic(40);
  Track track = truth;
  LowPass(6.0, 60.0, &track);
  for (int t = 0; t < 40; ++t) EXPECT_LT((track[t] - truth[t]).norm(), 2e-3) << t;
  Track still(10, Eigen::Vector3d(1, 2, 3));
  LowPass(1.0, 60.0, &still);
  for (const Eigen::Vector3d& position : still) {
    EXPECT_LT((position - Eigen::Vector3d(1, 2, 3)).norm(), 1e-12);
  }
}

TEST(LowPassTest, NoiseGoesDown) {
  Random random(3);
  Track track;
  for (int t = 0; t < 600; ++t) track.push_back({random.Normal(), random.Normal(), 0.0});
  LowPass(6.0, 120.0, &track);
  double power = 0.0;
  for (const Eigen::Vector3d& position : track) power += position.squaredNorm();
  EXPECT_LT(power / 1200.0, 0.15);  // of 1; the band is a tenth of all
}

TEST(ResampleTest, CubicsAreExact) {
  Track track;
  for (int t = 0; t < 21; ++t) {
    const double s = t / 100.0;
    track.push_back({s, s * s, s * s * s});
  }
  for (double rate : {60.0, 100.0, 250.0, 33.0}) {
    const Track other = ResampleTrack(track, 100.0, rate);
    ASSERT_EQ(static_cast<int>(other.size()), ResampledFrames(21, 100.0, rate));
    for (std::size_t t = 0; t < other.size(); ++t) {
      const double s = static_cast<double>(t) / rate;
      EXPECT_LT((other[t] - Eigen::Vector3d(s, s * s, s * s * s)).norm(), 1e-12)
          << rate << " " << t;
    }
  }
  EXPECT_EQ(ResampledFrames(21, 100.0, 100.0), 21);
  EXPECT_EQ(ResampledFrames(121, 120.0, 60.0), 61);
}

TEST(ResampleTest, PushesKeepTheirImpulse) {
  Push push;
  push.start_frame = 7;
  for (int i = 0; i < 9; ++i)
    push.force.push_back(Eigen::Vector4d(100.0 + i * i, -i, 3.0, 0.5 * i));
  Eigen::Vector4d impulse = Eigen::Vector4d::Zero();
  for (const Eigen::Vector4d& row : push.force) impulse += row / 100.0;
  for (double rate : {60.0, 120.0, 100.0, 37.0, 1000.0}) {
    const Push other = ResamplePush(push, 100.0, rate);
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();
    for (const Eigen::Vector4d& row : other.force) sum += row / rate;
    EXPECT_LT((sum - impulse).norm(), 1e-12) << rate;
    EXPECT_NEAR(other.start_frame / rate, 0.07, 0.5 / 100.0 + 1.0 / rate);
    // And their middle: a row acts at its frame (push_estimation.h).
    double before = 0.0, after = 0.0;
    for (size_t i = 0; i < push.force.size(); ++i) {
      before += (push.start_frame + static_cast<double>(i)) / 100.0 * push.force[i][0] / 100.0;
    }
    for (size_t i = 0; i < other.force.size(); ++i) {
      after += (other.start_frame + static_cast<double>(i)) / rate * other.force[i][0] / rate;
    }
    EXPECT_NEAR(after / sum[0], before / impulse[0], 1.5e-3) << rate;
  }
  EXPECT_EQ(ResamplePush(push, 100.0, 100.0).force, push.force);
}

TEST(ResampleTest, Weights) {
  EXPECT_EQ(ResampleWeights({1, 1, 0, 1, 1}, 100.0, 200.0),
            (std::vector<double>{1, 1, 1, 0, 0, 0, 1, 1, 1}));
  EXPECT_EQ(ResampleWeights({1, 1, 0, 1, 1}, 100.0, 50.0), (std::vector<double>{1, 0, 1}));
}

Recording Walk(double fps, int frames) {
  Recording recording;
  recording.fps = fps;
  RecordedPerson person;
  person.mass_kg = 70.0;
  for (int t = 0; t < frames; ++t) {
    const double x = 0.3 * std::sin(2.0 * t / fps);
    person.hip.push_back({x, 0.0, 0.95});
    person.left_ankle.push_back({0.0, 0.1, 0.08});
    person.right_ankle.push_back({0.0, -0.1, 0.08});
  }
  recording.people = {person};
  return recording;
}

TEST(MotionPreparationTest, FilterThenResample) {
  Recording recording = Walk(120.0, 121);
  recording.people[0].weight.assign(121, 1.0);
  recording.people[0].weight[60] = 0.0;
  PreparationOptions options;
  options.lowpass_hz = 10.0;
  options.resample_fps = 60.0;
  ASSERT_FALSE(PrepareMotion(options, &recording));
  EXPECT_EQ(recording.fps, 60.0);
  EXPECT_EQ(recording.num_frames(), 61);
  EXPECT_NEAR(recording.people[0].hip[30].x(), 0.3 * std::sin(1.0), 1e-3);
  EXPECT_EQ(recording.people[0].weight[30], 0.0);
  EXPECT_EQ(recording.people[0].weight[31], 1.0);
}

TEST(MotionPreparationTest, WhatCannotBeDone) {
  const auto message = [](PreparationOptions options, int frames = 121) {
    if (const MaybeError wrong = CheckPreparation(options)) return wrong->ToString();
    Recording recording = Walk(120.0, frames);
    const MaybeError failed = PrepareMotion(options, &recording);
    return failed ? failed->ToString() : std::string("done");
  };
  EXPECT_TRUE(Contains(message({-1.0, 0.0, 0.0}), "--max_gap_s"));
  EXPECT_TRUE(Contains(message({0.1, -6.0, 0.0}), "--lowpass_hz"));
  EXPECT_TRUE(Contains(message({0.1, 0.1, 0.0}), "at least 0.5 Hz"));
  EXPECT_TRUE(Contains(message({0.1, std::nan(""), 0.0}), "--lowpass_hz"));
  EXPECT_TRUE(Contains(message({0.1, 0.0, 0.5}), "--resample_fps"));
  EXPECT_TRUE(Contains(message({0.1, 60.0, 0.0}), "must be below 59.9 Hz"));
  EXPECT_TRUE(Contains(message({0.1, 0.0, 60.0}), "pass --lowpass_hz=15"));
  EXPECT_TRUE(Contains(message({0.1, 40.0, 60.0}), "pass --lowpass_hz=15"));
  EXPECT_TRUE(Contains(message({0.1, 2.0, 10.0}, 13), "fewer than three frames"));
  EXPECT_EQ(message({0.1, 0.0, 240.0}), "done");
}

// The frame behind a hidden one has a velocity that leans on it.
TEST(MotionPreparationTest, WeightsReachThePendulum) {
  Recording recording = Walk(60.0, 10);
  recording.people[0].weight.assign(10, 1.0);
  recording.people[0].weight[4] = 0.0;
  const PendulumRecording pendulum = MakePendulumRecording(recording);
  for (int t = 0; t < 10; ++t) {
    EXPECT_EQ(pendulum.Weight(0, t), t == 4 || t == 5 ? 0.0 : 1.0) << t;
  }
  recording.people[0].weight.clear();
  EXPECT_EQ(MakePendulumRecording(recording).Weight(0, 4), 1.0);
}

}  // namespace
}  // namespace pushid
