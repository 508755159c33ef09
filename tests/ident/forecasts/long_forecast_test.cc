// Long forecasts by the second, and groups among their sampled futures.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "ident/forecasts/group_forecasts.h"
#include "tests/models/body_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

constexpr double kForecastDt = 1.0 / 60.0;

// Goes forwards at 0.6 m/s for a second, then stands.
BodyMotion Stopping(int frames) {
  BodyMotion motion;
  for (int t = 0; t < frames; ++t) {
    motion.push_back(Placed(StandingPose(), 0.0, {0.6 * kForecastDt * std::min(t, 60), 0, 0}));
  }
  return motion;
}

TEST(LongForecastTest, SecondsByHand) {
  const GroupMotion group{{Stopping(185), Stopping(185)}, kForecastDt, 0};
  const auto seconds = BySecond({group}, {group});
  ASSERT_EQ(seconds.size(), 3u) << "whole seconds alone";
  EXPECT_NEAR(seconds[0].hip_speed, 0.6, 1e-9);
  EXPECT_NEAR(seconds[1].hip_speed, 0.0, 1e-9);
  EXPECT_NEAR(seconds[2].hip_way, 0.6, 1e-9);
  EXPECT_LT(*seconds[0].standing, 0.1);
  EXPECT_EQ(*seconds[2].standing, 1.0);
  EXPECT_EQ(ToJson(seconds)[2]["second"], 3);
  EXPECT_TRUE(Contains(SecondsText("generator", seconds), "generator, second"));
}

TEST(LongForecastTest, NothingMakesNoSeconds) {
  EXPECT_TRUE(BySecond({}, {}).empty());
  const GroupMotion brief{{Stopping(20)}, kForecastDt, 0};
  EXPECT_TRUE(BySecond({brief}, {brief}).empty());
}

// Futures at chosen places: the recorded hip is at 0.
class FixedFutures : public MotionGenerator {
 public:
  explicit FixedFutures(std::vector<float> places) : places_(std::move(places)) {}
  const ParticleLayout& layout() const override { return layout_; }
  std::vector<Trajectories> Forecast(const std::vector<ObservedMotion>&, int) const override {
    return {};
  }
  std::vector<std::vector<SampledFuture>> Sample(const std::vector<ObservedMotion>& people,
                                                 int frames, int count,
                                                 const NormalSource&) const override {
    std::vector<SampledFuture> futures;
    for (int k = 0; k < count; ++k) {
      futures.push_back({Trajectories::Constant(3 * kBodyJoints, frames, places_[k])});
    }
    return std::vector<std::vector<SampledFuture>>(people.size(), futures);
  }

 private:
  ParticleLayout layout_;
  std::vector<float> places_;
};

TEST(GroupSpreadTest, InsideAndWidthByHand) {
  BodyRecording recording;
  recording.bodies = {BodyMotion(10, StandingPose())};
  recording.pendulum.hip = {{}};
  recording.pendulum.hip[0].resize(10);
  recording.pendulum.scene.people.resize(1);
  recording.pendulum.scene.people[0].body.mass = 70.0;
  GroupSpread spread;
  spread.samples = 2;
  const auto no_noise = [] { return 0.0; };
  AddSpread(FixedFutures({-0.1f, 0.3f}), recording, {}, 1, no_noise, &spread);
  EXPECT_EQ(spread.Inside(), 1.0);
  EXPECT_NEAR(spread.Width(), 0.4, 1e-6);
  AddSpread(FixedFutures({0.1f, 0.3f}), recording, {}, 1, no_noise, &spread);
  EXPECT_EQ(spread.Inside(), 0.5);
  EXPECT_NEAR(spread.Width(), 0.3, 1e-6);
  EXPECT_EQ(ToJson(spread)["hip_x_inside"], 0.5);
  EXPECT_TRUE(Contains(SpreadText(spread), "33.3 % if their spread"));
}

}  // namespace
}  // namespace pushid
