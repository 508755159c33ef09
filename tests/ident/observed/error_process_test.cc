// The filter of a rollout's error against the covariance that it stands for.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>

#include "datasets/files/random.h"
#include "ident/observed/recording_filter.h"
#include "models/decompositions.h"

namespace pushid {
namespace {

constexpr double kDt = 1.0 / 60.0;

// c^2 dt^2 A K_v A', frames 1 .. n.
Eigen::MatrixXd ErrorCovariance(int n, double dt) {
  Eigen::MatrixXd v(n, n);
  for (int t = 0; t < n; ++t) {
    for (int u = 0; u < n; ++u) {
      v(t, u) = std::exp(-std::abs(t - u) * dt / 0.3) - std::exp(-(t + u + 2) * dt / 0.3);
    }
  }
  const Eigen::MatrixXd sum =
      Eigen::MatrixXd::Ones(n, n).triangularView<Eigen::Lower>().toDenseMatrix();
  return dt * dt * sum * v * sum.transpose();
}

Eigen::MatrixXd Scaled(int n, double dt) {
  const int reference = static_cast<int>(std::lround(31.0 / 60.0 / dt));
  return ErrorCovariance(n, dt) / ErrorCovariance(reference, dt)(reference - 1, reference - 1);
}

// By hand: the first frame moves by dt v with var v = c^2 (1 - r^2).
TEST(ErrorProcess, FirstFrameByHand) {
  ErrorProcess process(kDt);
  const double r = std::exp(-kDt / 0.3);
  const double c2 = 1.0 / ErrorCovariance(31, kDt)(30, 30);
  const double pp = kDt * kDt * c2 * (1.0 - r * r);
  const ErrorProcess::Gains gains = process.Next(true);
  EXPECT_NEAR(gains.variance, pp + 0.0025, 1e-15);
  EXPECT_NEAR(gains.position, pp / (pp + 0.0025), 1e-12);
}

// Sum of squares of the whitened errors and forecast: those of the dense covariance.
TEST(ErrorProcess, EqualsTheDenseCovariance) {
  constexpr int kFrames = 90, kSeen = 40;
  const Eigen::MatrixXd k = Scaled(kFrames, kDt);
  const Eigen::MatrixXd noise = 0.0025 * Eigen::MatrixXd::Identity(kSeen, kSeen);
  Random random(5);
  Eigen::VectorXd y(kSeen);
  for (int t = 0; t < kSeen; ++t) y[t] = random.Normal();

  ErrorProcess process(kDt);
  ErrorProcess::State state;
  double misfit = 0.0;
  for (int t = 0; t < kSeen; ++t) {
    const ErrorProcess::Gains gains = process.Next(true);
    state = process.Predicted(state);
    const double innovation = y[t] - state.position;
    state.position += gains.position * innovation;
    state.velocity += gains.velocity * innovation;
    misfit += innovation * innovation / gains.variance;
  }
  const Eigen::MatrixXd inverse = Inverse(k.topLeftCorner(kSeen, kSeen) + noise);
  EXPECT_NEAR(misfit, y.dot(inverse * y), 1e-8 * misfit);
  for (int t = kSeen; t < kFrames; ++t) {
    const Eigen::VectorXd row = k.row(t).head(kSeen).transpose();
    EXPECT_NEAR(state.position + process.Reach(t - kSeen + 1) * state.velocity,
                row.dot(inverse * y), 1e-9)
        << t;
  }
}

TEST(ErrorProcess, FramesThatWereNotSeenTellNothing) {
  ErrorProcess process(kDt);
  for (int t = 0; t < 10; ++t) EXPECT_EQ(process.Next(false).variance, 0.0);
}

}  // namespace
}  // namespace pushid
