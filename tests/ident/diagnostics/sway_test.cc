// Sway of known tracks, and of a model's own noise.
#include "ident/diagnostics/sway.h"

#include <gtest/gtest.h>

#include "tests/ident/laboratory_samples.h"

namespace pushid {
namespace {

constexpr double kSwayDt = 0.01;
constexpr int kSwayFrames = 6001;  // 60 s

// 1 cm to and fro along x at 0.5 Hz for a minute: 30 periods of 4 cm, 1 cm / sqrt(2), 0.5 Hz, and
// no area.
TEST(Sway, SineByHand) {
  std::vector<Eigen::Vector2d> track;
  for (int t = 0; t < kSwayFrames; ++t) {
    track.emplace_back(0.3 + 0.01 * std::sin(M_PI * t * kSwayDt), 0.0);
  }
  const Sway sway = SwayOf(track, kSwayDt);
  EXPECT_NEAR(sway[kSwayPath], 1.2, 0.005);
  EXPECT_NEAR(sway[kSwaySpeed], 0.02, 1e-4);
  EXPECT_NEAR(sway[kSwayRmsX], 0.01 / std::sqrt(2.0), 2e-5);
  EXPECT_EQ(sway[kSwayRmsY], 0.0);
  EXPECT_NEAR(sway[kSwayFrequencyX], 0.5, 0.005);
  EXPECT_EQ(sway[kSwayFrequencyY], 0.0);
  EXPECT_NEAR(sway[kSwayEllipse], 0.0, 1e-9);
}

// A circle of 1 cm at 1 Hz and a slower one of half of it along y.
TEST(Sway, EllipseByHand) {
  std::vector<Eigen::Vector2d> track;
  for (int t = 0; t < kSwayFrames; ++t) {
    track.emplace_back(0.01 * std::cos(2.0 * M_PI * t * kSwayDt),
                       0.005 * std::sin(2.0 * M_PI * t * kSwayDt));
  }
  const Sway sway = SwayOf(track, kSwayDt);
  // F_95(2, many) = 2.996; variances 1/2 of the squares.
  EXPECT_NEAR(sway[kSwayEllipse], 2.0 * M_PI * 2.9957 * 0.5 * 0.01 * 0.005, 1e-6);
  EXPECT_NEAR(sway[kSwayFrequencyY], 1.0, 0.005);
  // 4.844 times the long half-axis around an ellipse of half that width.
  EXPECT_NEAR(sway[kSwayPath], 60.0 * 0.0484422, 0.01);
}

// What shakes faster than people sway is measurement noise.
TEST(Sway, FastNoiseIsLeftOut) {
  std::vector<Eigen::Vector2d> track;
  for (int t = 0; t < kSwayFrames; ++t) {
    track.emplace_back(0.01 * std::sin(M_PI * t * kSwayDt), 0.001 * (t % 2 == 0 ? 1.0 : -1.0));
  }
  const Sway sway = SwayOf(track, kSwayDt);
  EXPECT_NEAR(sway[kSwayPath], 1.2, 0.02);
  EXPECT_LT(sway[kSwayRmsY], 5e-5);  // of 1 mm: but for the ends
}

TEST(Sway, QuietIsUndisturbedForLong) {
  const ModelOptions options = StandingOptions();
  const ParameterSet<double> p = StandingGains(1500.0, 400.0);
  Scene scene = StandingScene(kSwayDt);
  EXPECT_TRUE(IsQuiet(RecordingOf(scene, options, p, 2000, "A")));
  EXPECT_FALSE(IsQuiet(RecordingOf(scene, options, p, 500, "A")));
  Scene moves = scene;
  moves.ground = OscillatingGround(0, 2000, kSwayDt, [](double s) { return 1e-3 * SumOfSines(s); });
  EXPECT_FALSE(IsQuiet(RecordingOf(moves, options, p, 2000, "A")));
  scene.pushes.push_back(
      MakeScenePush(0, 10, PushKind::kExternal, HalfSinePush(Body{}, 5.0, 20, kSwayDt)));
  EXPECT_FALSE(IsQuiet(RecordingOf(scene, options, p, 2000, "A")));
}

// People who sway as the model's noise makes them: what is measured lies within the simulated.
TEST(Sway, SimulatedAsMeasured) {
  ModelOptions options = StandingOptions();
  options.process_noise = ProcessNoise::kDiagonal;
  ParameterSet<double> p = StandingGains(1300.0, 400.0);
  p[kSigmaX] = p[kSigmaY] = 1.0;
  p[kSigmaX + 2] = 3.0, p[kSigmaX + 3] = 1.5;
  FrameTable<Vector4<double>> noise(kSwayFrames, 1);
  Random random(6);
  for (int t = 0; t < kSwayFrames; ++t) {
    for (double& w : noise.At(t, 0)) w = random.Normal();
  }
  for (bool platforms : {false, true}) {
    SCOPED_TRACE(platforms);
    const PendulumRecording recording =
        RecordingOf(StandingScene(kSwayDt), options, p, kSwayFrames, "A", platforms, &noise);
    const auto people = SwayOfPeople({recording}, options, {{p}}, 20, 1);
    ASSERT_EQ(people.size(), 1u);
    const PersonSway& one = people[0];
    EXPECT_EQ(one.repeats, 20);
    EXPECT_EQ(one.by_plates, platforms);
    for (int i = 0; i < kNumSwayMeasures; ++i) {
      EXPECT_GT(one.spread[i], 0.0) << kSwayMeasures[i].name;
      EXPECT_LT(std::abs(one.measured[i] - one.simulated[i]), 4.0 * one.spread[i])
          << kSwayMeasures[i].name;
    }
    EXPECT_GT(one.measured[kSwayRmsX], one.measured[kSwayRmsY]);
    EXPECT_EQ(SwayTable(people).rows().size(), 1u + kNumSwayMeasures);
    // Without process noise only the measured ones.
    ModelOptions still = options;
    still.process_noise = ProcessNoise::kNone;
    EXPECT_EQ(SwayOfPeople({recording}, still, {{p}}, 20, 1)[0].repeats, 0);
  }
}

}  // namespace
}  // namespace pushid
