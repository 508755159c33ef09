// Intervals of variances that are the sum of parts, each known by its own degrees of freedom.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "datasets/files/random.h"
#include "ident/problem/statistics.h"
#include "ident/uncertainty/covariance.h"

namespace pushid {
namespace {

constexpr double kKnown = std::numeric_limits<double>::infinity();

Scatter Parts(double variance, double freedom, double known_variance) {
  Scatter scatter;
  scatter.Add(Eigen::MatrixXd::Constant(1, 1, variance), freedom);
  scatter.Add(Eigen::MatrixXd::Constant(1, 1, known_variance), kKnown);
  return scatter;
}

TEST(Scatter, OnePartIsStudents) {
  const ScatterOf of = Parts(4.0, 3.0, 0.0).OfColumn(0);
  EXPECT_NEAR(of.standard_error, 2.0, 1e-12);
  EXPECT_NEAR(of.quantile, StudentQuantile95(3.0), 1e-12);
  EXPECT_EQ(of.freedom, 3.0);
}

// 12.706^2 * 1 + 1.96^2 * 9, by hand.
TEST(Scatter, EachPartHasItsOwnQuantile) {
  const ScatterOf of = Parts(1.0, 1.0, 9.0).OfColumn(0);
  EXPECT_NEAR(of.standard_error, std::sqrt(10.0), 1e-12);
  EXPECT_NEAR(of.HalfWidth(), std::sqrt(12.7062 * 12.7062 + 1.95996 * 1.95996 * 9.0), 1e-3);
  EXPECT_EQ(of.freedom, 1.0);
}

TEST(Scatter, SumsOfColumnsHaveTheLeastFreedom) {
  Scatter scatter;
  scatter.parts.push_back({Eigen::Matrix3d::Identity(), Eigen::Vector3d(5.0, 2.0, 1.0)});
  const ScatterOf of = scatter.Of(Eigen::Vector3d(3.0, 4.0, 0.0));
  EXPECT_NEAR(of.standard_error, 5.0, 1e-12);
  EXPECT_EQ(of.freedom, 2.0);
}

// A mean of two people beside a known part, whatever the ratio of the two.
TEST(Scatter, IntervalsCoverWhateverTheParts) {
  Random random(3);
  for (double known : {0.0, 0.1, 1.0, 10.0}) {
    int covered = 0;
    constexpr int kTimes = 2000;
    for (int i = 0; i < kTimes; ++i) {
      const double a = random.Normal(), b = random.Normal();
      const double error = 0.5 * (a + b) + std::sqrt(known) * random.Normal();
      covered +=
          std::abs(error) <= Parts(0.25 * (a - b) * (a - b), 1.0, known).OfColumn(0).HalfWidth();
    }
    EXPECT_GE(covered, 0.94 * kTimes) << known;
  }
}

}  // namespace
}  // namespace pushid
