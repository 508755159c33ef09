// Scores of sampled futures: scores of normal samples, the search of a path.
#include "ident/forecasts/forecast_spread.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numeric>

#include "tests/models/generators/generator_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

// Truths and samples from N(0, 1), and samples that spread too little.
class SpreadTest : public ::testing::Test {
 protected:
  WindowScores Scores(double sample_size) {
    Random random(1);
    std::vector<ForecastWindow> windows;
    std::vector<std::vector<SampledFuture>> samples;
    const auto draw = [&](double size) {
      Trajectories motion(12, kForecastFrames);
      for (float& x : motion.reshaped()) x = static_cast<float>(size * random.Normal());
      return motion;
    };
    for (int i = 0; i < 60; ++i) {
      windows.push_back({"walk", Trajectories::Zero(12, 25), draw(1.0)});
      samples.emplace_back();
      for (int k = 0; k < 39; ++k) samples.back().push_back({draw(sample_size), 0.0});
    }
    spread_ = ScoresOf(windows, ZeroVelocity(windows), FourParticles(), samples);
    return spread_.mean;
  }
  ForecastScores spread_;
};

// CRPS of N(0, 1) for a truth of N(0, 1): E|X - y| - E|X - X'| / 2 = E|X - X'| / 2 = 1/sqrt(pi).
TEST_F(SpreadTest, OfTheRightSize) {
  const WindowScores scores = Scores(1.0);
  EXPECT_NEAR(scores.coverage[0], 0.9, 0.03);
  EXPECT_NEAR(scores.crps[0], 1.0 / std::sqrt(M_PI), 0.04);
  EXPECT_LT(scores.best[0], 2.0);
}

TEST_F(SpreadTest, TooNarrowFuturesScoreWorseAndCoverLess) {
  const WindowScores right = Scores(1.0), narrow = Scores(0.3);
  EXPECT_LT(narrow.coverage[2], 0.6);
  EXPECT_GT(narrow.crps[2], right.crps[2]);
  EXPECT_GT(narrow.energy[2], right.energy[2]);
}

// The likeliest of three futures is 3 cm off along every joint's x; nearer ones do not count.
TEST(MostProbableTest, ByHand) {
  const std::vector<ForecastWindow> windows = {
      {"walk", Trajectories::Zero(12, 25), Trajectories::Zero(12, kForecastFrames)}};
  const auto off = [](float x) {
    Trajectories motion = Trajectories::Zero(12, kForecastFrames);
    for (int i = 0; i < 12; i += 3) motion.row(i).setConstant(x);
    return motion;
  };
  const std::vector<std::vector<SampledFuture>> samples = {
      {{off(0.01f), -5.0}, {off(0.03f), 2.0}, {off(0.02f), 1.0}}};
  ParticleLayout layout = FourParticles();
  const double counted = std::accumulate(layout.weights.begin(), layout.weights.end(), 0.0);
  const ForecastScores spread = ScoresOf(windows, ZeroVelocity(windows), layout, samples);
  EXPECT_NEAR(spread.mean.probable[4], 0.03 * counted / layout.joints, 1e-7);
  EXPECT_NEAR(spread.actions.at("walk").best[4], 0.01 * counted / layout.joints, 1e-7);
}

TEST_F(SpreadTest, StandsBesideTheErrors) {
  Scores(1.0);
  nlohmann::ordered_json json = ToJson(spread_);
  EXPECT_TRUE(json["mean"]["MPJPE_mm"].contains("80"));
  EXPECT_NEAR(json["mean"]["coverage_90"]["1000"].get<double>(), 0.9, 0.05);
  EXPECT_TRUE(json["actions"]["walk"]["energy_score_mm"].contains("80"));
  EXPECT_TRUE(Contains(ForecastScoresText(spread_), "best of n"));
}

// Three futures, of which two end at the target; the likelier of the two is chosen, not the
// likeliest of all.
TEST(PathSearchTest, TakesTheMostProbableThatEndsThere) {
  const Trajectories there = Trajectories::Zero(12, 5), away = Trajectories::Ones(12, 5);
  const std::vector<SampledFuture> futures = {{there, -9.0}, {there, -4.0}, {away, -1.0}};
  const auto path =
      Unwrapped(MostProbablePath(futures, Eigen::VectorXf::Zero(12), 0.1, FourParticles()));
  EXPECT_EQ(path.future, 1);
  EXPECT_EQ(path.near, 2);
  EXPECT_EQ(path.log_likelihood, -4.0);
  EXPECT_TRUE(Contains(ProblemOf(MostProbablePath(futures, Eigen::VectorXf::Constant(12, 5.0f), 0.1,
                                                  FourParticles())),
                       "raise --samples"));
}

}  // namespace
}  // namespace pushid
