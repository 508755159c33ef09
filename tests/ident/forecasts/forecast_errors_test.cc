// Errors of forecasts: by hand, and the check values of the published clips.
#include <nlohmann/json.hpp>

#include "ident/forecasts/forecast_spread.h"
#include "ident/solver/solver.h"
#include "models/generators/particle_generator.h"
#include "tests/mocap_support.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

ParticleLayout OneParticle() {
  ParticleLayout layout;
  layout.names = {"point"};
  layout.mirrored = {0};
  layout.parents = {kNoBone};
  layout.weights = {1.0f};
  layout.joints = 2;
  return layout;
}

// A point that moves 2 cm a frame from where it was last seen; of two joints one never moves.
TEST(ForecastErrorsTest, ByHand) {
  ForecastWindow window{"walk", Trajectories::Zero(3, 25), Trajectories::Zero(3, 25)};
  for (int t = 0; t < 25; ++t) window.future(1, t) = 0.02f * static_cast<float>(t + 1);
  ForecastWindow still{"stand", Trajectories::Zero(3, 25), Trajectories::Zero(3, 25)};
  const std::vector<ForecastWindow> windows = {window, still, window};
  const ForecastScores errors = ScoresOf(windows, ZeroVelocity(windows), OneParticle());
  EXPECT_NEAR(errors.actions.at("walk").mpjpe[0], 0.02, 1e-7);  // frame 1, 80 ms: 4 cm / 2
  EXPECT_NEAR(errors.actions.at("walk").mpjpe[4], 0.25, 1e-6);  // frame 24: 50 cm / 2
  EXPECT_NEAR(errors.mean.mpjpe[4], 0.125, 1e-6);               // actions count alike
  const nlohmann::ordered_json json = ToJson(errors);
  EXPECT_NEAR(json["mean"]["MPJPE_mm"]["80"].get<double>(), 10.0, 1e-4);
  EXPECT_EQ(json["actions"]["walk"]["windows"], 2);
}

// A motion that a linear rule continues exactly.
TEST(RidgeForecastTest, ContinuesWhatIsLinear) {
  const auto motion = [](float phase) {
    Trajectories wave(3, 200);
    for (int t = 0; t < 200; ++t) {
      wave.col(t) << std::sin(0.1f * t + phase), std::cos(0.07f * t), 0.3f * std::sin(0.2f * t);
    }
    return wave;
  };
  RidgeFit fit;
  for (float phase : {0.0f, 1.0f, 2.0f}) fit.Add(motion(phase), 25, 25);
  const RidgeForecast ridge = fit.Solve(1e-9);
  const Trajectories other = motion(0.5f);
  const Trajectories forecast = ridge.Forecast(other.middleCols(30, 25));
  EXPECT_LT((forecast - other.middleCols(55, 25)).cwiseAbs().maxCoeff(), 1e-3f);
}

class RealForecastTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (MocapRoot().empty()) GTEST_SKIP() << kNoMocap;
    MocapFolder read = Unwrapped(ReadMocapFolder(MocapRoot()));
    mocap_ = std::move(read);
    windows_ = MakeForecastWindows(mocap_, ForecastProtocol::kValidation, 1);
  }
  void Expect(const WindowScores& errors, const HorizonErrors& expected_mm, double tolerance_mm) {
    for (size_t k = 0; k < expected_mm.size(); ++k) {
      EXPECT_NEAR(1e3 * errors.mpjpe[k], expected_mm[k], tolerance_mm) << k;
    }
  }
  MocapFolder mocap_;
  std::vector<ForecastWindow> windows_;
};

TEST_F(RealForecastTest, ZeroVelocityScoresAsPublished) {
  const auto errors = ScoresOf(windows_, ZeroVelocity(windows_), mocap_.skeleton.layout);
  Expect(errors.actions.at("basketball"), {23.50, 45.64, 85.90, 103.47, 173.92}, 0.05);
  Expect(errors.actions.at("basketball_signal"), {8.76, 16.54, 30.81, 37.18, 65.16}, 0.05);
  Expect(errors.actions.at("directing_traffic"), {14.88, 28.87, 54.77, 66.33, 119.01}, 0.05);
  Expect(errors.actions.at("jumping"), {19.11, 36.28, 66.43, 79.82, 153.64}, 0.05);
  Expect(errors.actions.at("running"), {41.67, 79.42, 144.70, 170.16, 230.57}, 0.05);
  Expect(errors.actions.at("soccer"), {27.33, 52.53, 99.25, 120.23, 216.96}, 0.05);
  Expect(errors.actions.at("walking"), {28.87, 56.03, 105.24, 126.88, 236.59}, 0.05);
  Expect(errors.mean, {23.45, 45.04, 83.87, 100.58, 170.84}, 0.05);
}

TEST_F(RealForecastTest, RidgeScoresAsPublished) {
  RidgeFit fit;
  for (const LearntMotion& learnt : LearntMotions(mocap_, false)) {
    if (learnt.phase == 0) fit.Add(learnt.motion, kObservedFrames, kForecastFrames);
  }
  const std::map<double, HorizonErrors> expected = {{1e3, {9.06, 18.84, 43.45, 56.56, 120.61}},
                                                    {1e4, {8.99, 18.84, 43.37, 56.27, 118.14}},
                                                    {1e5, {9.26, 19.37, 43.78, 56.30, 114.21}}};
  for (const auto& [penalty_mm2, mpjpe_mm] : expected) {
    const RidgeForecast ridge = fit.Solve(1e-6 * penalty_mm2);
    std::vector<Trajectories> forecasts;
    for (const ForecastWindow& window : windows_) {
      forecasts.push_back(ridge.Forecast(window.observed));
    }
    Expect(ScoresOf(windows_, forecasts, mocap_.skeleton.layout).mean, mpjpe_mm, 0.1);
  }
}

}  // namespace
}  // namespace pushid
