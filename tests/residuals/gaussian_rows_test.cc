// Gaussian densities as squares: exact, and good enough to find drift and noise of Langevin paths.
#include <ceres/autodiff_cost_function.h>
#include <ceres/covariance.h>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <memory>
#include <vector>

#include "datasets/files/random.h"
#include "models/decompositions.h"
#include "residuals/cost_functions/likelihood_residual.h"

namespace pushid {
namespace {

using Eigen::Matrix2d, Eigen::MatrixXd, Eigen::Vector2d, Eigen::VectorXd;

TEST(GaussianRows, HalfTheirSquaresAreTheNegativeLogDensity) {
  Random random(3);
  for (int trial = 0; trial < 50; ++trial) {
    Matrix4<double> lower = Matrix4<double>::Zero();
    Vector4<double> v;
    for (int i = 0; i < 4; ++i) {
      v[i] = random.Normal();
      for (int j = 0; j < i; ++j) lower(i, j) = random.Normal();
      lower(i, i) = std::exp(random.Normal());
    }
    double shift[4], rows[8];
    for (int i = 0; i < 4; ++i) shift[i] = random.Uniform(0.1, 3.0) - std::log(lower(i, i));
    ASSERT_TRUE((GaussianRows<double, 4>(v, lower, shift, rows)));
    const double half = 0.5 * Eigen::Map<Eigen::Matrix<double, 8, 1>>(rows).squaredNorm();
    const Matrix4<double> covariance = lower * lower.transpose();
    const double expected = 0.5 * v.dot(covariance.inverse() * v) +
                            0.5 * std::log(covariance.determinant()) + 2.0 * std::log(2.0 * M_PI);
    EXPECT_NEAR(half - GaussianOffset<4>(shift), expected, 1e-9 * (1.0 + std::abs(expected)));
  }
}

TEST(GaussianRows, EndWhereTheNoiseHasFallenTooFar) {
  const Matrix4<double> lower = 0.5 * Matrix4<double>::Identity();
  const double shift[4] = {0.5, 0.5, 0.5, 0.5};
  double rows[8];
  EXPECT_FALSE((GaussianRows<double, 4>(Vector4<double>::Zero(), lower, shift, rows)));
}

// dS = f(S) dt + g dW by Euler and Maruyama, f(S) = K (m - S).
template <int N>
std::vector<Eigen::Matrix<double, N, 1>> LangevinPath(const Eigen::Matrix<double, N, N>& k,
                                                      const Eigen::Matrix<double, N, 1>& m,
                                                      const Eigen::Matrix<double, N, N>& g,
                                                      int samples, double dt, uint64_t seed) {
  Random random(seed);
  std::vector<Eigen::Matrix<double, N, 1>> path = {m};
  while (static_cast<int>(path.size()) < samples) {
    Eigen::Matrix<double, N, 1> w;
    for (double& one : w) one = random.Normal();
    const auto& now = path.back();
    path.push_back(now + dt * (k * (m - now)) + std::sqrt(dt) * (g * w));
  }
  return path;
}

// Parameters: K by rows, m, then the lower triangle of g with logarithms on its diagonal.
template <int N>
constexpr int kLangevinParameters = N* N + N + N*(N + 1) / 2;

template <typename T, int N>
Eigen::Matrix<T, N, N> NoiseOf(const T* p) {
  using std::exp;
  Eigen::Matrix<T, N, N> g = Eigen::Matrix<T, N, N>::Zero();
  const T* at = p + N * N + N;
  for (int i = 0; i < N; ++i) {
    for (int j = 0; j < i; ++j) g(i, j) = *at++;
    g(i, i) = exp(*at++);
  }
  return g;
}

template <int N>
struct LangevinTransition {
  Eigen::Matrix<double, N, 1> now, next;
  double dt;
  std::vector<double> shift;

  template <typename T>
  bool operator()(const T* p, T* rows) const {
    Eigen::Matrix<T, N, 1> f;
    for (int i = 0; i < N; ++i) {
      f[i] = T(0.0);
      for (int j = 0; j < N; ++j) f[i] += p[i * N + j] * (p[N * N + j] - now[j]);
    }
    const Eigen::Matrix<T, N, 1> v = (next - now).template cast<T>() / T(dt) - f;
    const Eigen::Matrix<T, N, N> lower = NoiseOf<T, N>(p) / T(std::sqrt(dt));
    return GaussianRows<T, N>(v, lower, shift.data(), rows);
  }
};

struct LangevinFit {
  VectorXd value, error;
};

// In rounds, each from rows built anew.
template <int N>
LangevinFit FitLangevin(const std::vector<Eigen::Matrix<double, N, 1>>& path, double dt,
                        VectorXd start) {
  constexpr int kSize = kLangevinParameters<N>;
  LangevinFit fit{std::move(start), VectorXd::Zero(kSize)};
  for (int round = 0; round < 12; ++round) {
    ceres::Problem problem;
    const auto g = NoiseOf<double, N>(fit.value.data());
    std::vector<double> shift;
    for (int i = 0; i < N; ++i) {
      shift.push_back(kFisherShift - std::log(g(i, i) / std::sqrt(dt)));
    }
    for (size_t t = 0; t + 1 < path.size(); ++t) {
      using Cost = ceres::AutoDiffCostFunction<LangevinTransition<N>, 2 * N, kSize>;
      problem.AddResidualBlock(new Cost(new LangevinTransition<N>{path[t], path[t + 1], dt, shift}),
                               nullptr, fit.value.data());
    }
    const VectorXd before = fit.value;
    ceres::Solver::Options options;
    options.logging_type = ceres::SILENT;
    options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
    options.function_tolerance = 1e-14;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    if ((fit.value - before).norm() > 1e-9 * before.norm()) continue;
    ceres::Covariance covariance(ceres::Covariance::Options{});
    EXPECT_TRUE(covariance.Compute(
        std::vector<std::pair<const double*, const double*>>{{fit.value.data(), fit.value.data()}},
        &problem));
    Eigen::Matrix<double, kSize, kSize, Eigen::RowMajor> of;
    covariance.GetCovarianceBlock(fit.value.data(), fit.value.data(), of.data());
    fit.error = of.diagonal().cwiseSqrt();
    break;
  }
  EXPECT_GT(fit.error.minCoeff(), 0.0) << "the rounds did not end";
  return fit;
}

TEST(TransitionLikelihood, AnOrnsteinUhlenbeckPathComesBackWithinThreeErrors) {
  using One = Eigen::Matrix<double, 1, 1>;
  constexpr double kDt = 0.01;
  const auto path = LangevinPath<1>(One(2.0), One(0.3), One(0.5), 6000, kDt, 11);
  VectorXd start(3);
  start << 0.5, 0.0, std::log(5.0);  // noise too large by ten
  const LangevinFit fit = FitLangevin<1>(path, kDt, start);
  const Eigen::Vector3d truth(2.0, 0.3, std::log(0.5));
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(fit.value[i], truth[i], 3.0 * fit.error[i]) << i;
  }
  EXPECT_NEAR(fit.error[2], 1.0 / std::sqrt(2.0 * 6000), 1e-3);  // Fisher's, of log g
}

// Drift by least squares, then g g' = covariance of what is left.
void ClosedForm(const std::vector<Vector2d>& path, double dt, Matrix2d* k, Vector2d* m,
                Matrix2d* noise) {
  const Eigen::Index steps = static_cast<Eigen::Index>(path.size()) - 1;
  MatrixXd inputs(steps, 3), rates(steps, 2);
  for (Eigen::Index t = 0; t < steps; ++t) {
    inputs.row(t) << 1.0, path[t].transpose();
    rates.row(t) = (path[t + 1] - path[t]).transpose() / dt;
  }
  const MatrixXd drift = SolveLeastNorm(inputs, rates);
  *k = -drift.bottomRows<2>().transpose();
  *m = k->inverse() * drift.row(0).transpose();
  const MatrixXd left = rates - inputs * drift;
  *noise = dt * left.transpose() * left / static_cast<double>(steps);
}

TEST(TransitionLikelihood, ACoupledPathComesBackAndEqualsTheClosedForm) {
  constexpr double kDt = 0.01;
  Matrix2d k, g;
  k << 2.0, -0.7, 0.4, 1.5;
  g << 0.5, 0.0, 0.2, 0.3;
  const Vector2d m(0.3, -0.1);
  const auto path = LangevinPath<2>(k, m, g, 6000, kDt, 12);
  VectorXd start(9);
  start << 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0;
  const LangevinFit fit = FitLangevin<2>(path, kDt, start);
  VectorXd truth(9);
  truth << k(0, 0), k(0, 1), k(1, 0), k(1, 1), m, std::log(g(0, 0)), g(1, 0), std::log(g(1, 1));
  for (int i = 0; i < 9; ++i) EXPECT_NEAR(fit.value[i], truth[i], 3.0 * fit.error[i]) << i;

  Matrix2d closed_k, closed_noise;
  Vector2d closed_m;
  ClosedForm(path, kDt, &closed_k, &closed_m, &closed_noise);
  const Matrix2d found = NoiseOf<double, 2>(fit.value.data());
  EXPECT_LT((found * found.transpose() - closed_noise).norm(), 1e-3 * closed_noise.norm());
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(fit.value[i], closed_k(i / 2, i % 2), 1e-3);
  EXPECT_LT((fit.value.segment<2>(4) - closed_m).norm(), 1e-3);
}

}  // namespace
}  // namespace pushid
