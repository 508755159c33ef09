// Drawn futures: proper scores against their closed forms, and draws that are as wide as they say.
#include "ident/prediction/futures.h"

#include <gtest/gtest.h>

#include "ident/fit/fit_setup.h"
#include "ident/fit/step_probability.h"
#include "ident/model/model_rollout.h"
#include "ident/prediction/evaluation.h"
#include "ident/problem/own_axes.h"
#include "ident/problem/statistics.h"
#include "models/rollout.h"
#include "tests/ident/fit_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

TEST(Crps, OfAUniformDistributionIsItsClosedForm) {
  Random random(3);
  std::vector<double> draws;
  for (int i = 0; i < 20000; ++i) draws.push_back(random.Unit());
  // CRPS of U(0, 1): the integral of (F - 1{x >= y})^2.
  for (double y : {-0.5, 0.3, 0.5, 1.2}) {
    const double inside = (y * y * y + (1.0 - y) * (1.0 - y) * (1.0 - y)) / 3.0;
    const double expected = y < 0.0 ? 1.0 / 3.0 - y : y > 1.0 ? y - 1.0 + 1.0 / 3.0 : inside;
    EXPECT_NEAR(Crps(draws, y), expected, 5e-3) << y;
  }
}

TEST(Crps, OfTwoDrawsByHand) {
  EXPECT_DOUBLE_EQ(Crps({0.0, 1.0}, 0.0), 0.0);  // 1/2 - |0 - 1| / 2; with n^2 it were 1/4
  EXPECT_DOUBLE_EQ(Crps({1.0, 0.0, 2.0}, 3.0), 2.0 - 2.0 / 3.0);
}

// Twenty draws are scored as a thousand are, on average.
TEST(Crps, FewDrawsAreNotBiased) {
  Random random(4);
  double few = 0.0, many = 0.0;
  constexpr int kTrials = 400;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<double> draws;
    for (int i = 0; i < 1000; ++i) draws.push_back(random.Normal());
    const double y = random.Normal();
    many += Crps(draws, y) / kTrials;
    draws.resize(20);
    few += Crps(draws, y) / kTrials;
  }
  EXPECT_NEAR(few, many, 0.03);
  EXPECT_NEAR(many, 1.0 / std::sqrt(M_PI), 0.04);  // of N(0, 1) against itself
}

}  // namespace
}  // namespace pushid
