#include <gtest/gtest.h>

#include <cmath>

#include "datasets/files/random.h"
#include "ident/problem/statistics.h"

namespace pushid {
namespace {

std::vector<double> Autoregressive(double memory, int length, uint64_t seed) {
  Random random(seed);
  std::vector<double> series = {random.Normal()};
  while (static_cast<int>(series.size()) < length) {
    series.push_back(memory * series.back() + random.Normal());
  }
  return series;
}

TEST(TimeSeries, AutocorrelationOfAnAutoregressionFallsByItsMemory) {
  const std::vector<double> r = Autocorrelation(Autoregressive(0.8, 200000, 1), 3);
  EXPECT_NEAR(r[0], 0.8, 0.01);
  EXPECT_NEAR(r[1], 0.64, 0.01);
  EXPECT_NEAR(r[2], 0.512, 0.015);
  EXPECT_EQ(Autocorrelation({3.0, 3.0, 3.0}, 1)[0], 0.0);
}

TEST(TimeSeries, CrossCorrelationPeaksAtTheDelay) {
  const std::vector<double> input = Autoregressive(0.0, 5000, 2);
  std::vector<double> answer(input.size(), 0.0);
  for (size_t t = 3; t < answer.size(); ++t) answer[t] = -2.0 * input[t - 3] + 5.0;
  const std::vector<double> r = CrossCorrelation(answer, input, 6);
  ASSERT_EQ(r.size(), 7u);
  EXPECT_NEAR(r[3], -1.0, 0.01);
  EXPECT_NEAR(r[0], 0.0, 0.05);
}

// White series are called coloured in 5 % of cases, coloured ones nearly always.
TEST(TimeSeries, LjungBoxRejectsAsOftenAsItSays) {
  const auto rejected = [](double memory) {
    int count = 0;
    for (uint64_t seed = 0; seed < 400; ++seed) {
      const std::vector<double> r = Autocorrelation(Autoregressive(memory, 200, seed), 10);
      count += ChiSquareTail(LjungBox(r, 200), 10) < 0.05;
    }
    return count / 400.0;
  };
  EXPECT_NEAR(rejected(0.0), 0.05, 0.035);
  EXPECT_GT(rejected(0.4), 0.95);
}

TEST(TimeSeries, ChiSquareTails) {
  EXPECT_NEAR(ChiSquareTail(3.841458820694124, 1), 0.05, 1e-12);
  EXPECT_NEAR(ChiSquareTail(18.30703805327515, 10), 0.05, 1e-12);
  EXPECT_EQ(ChiSquareTail(0.0, 4), 1.0);
}

TEST(TimeSeries, MeanAndItsError) {
  const MeanAndError m = MeanOf({1.0, 2.0, 3.0, 4.0});
  EXPECT_DOUBLE_EQ(m.mean, 2.5);
  EXPECT_DOUBLE_EQ(m.error, std::sqrt(5.0 / 3.0 / 4.0));
}

}  // namespace
}  // namespace pushid
