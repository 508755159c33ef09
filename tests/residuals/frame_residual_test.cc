// One frame's residual, and the robust weight.
#include "residuals/frame_residual.h"

#include <ceres/jet.h>

#include "tests/residuals/residual_samples.h"

namespace pushid {
namespace {

const Body kBody{72.0, 0.93, 0.08};

PendulumState<double> UniformState(double magnitude, Random* random) {
  PendulumState<double> state;
  for (int i = 0; i < 4; ++i) {
    state.q[i] = random->Uniform(-magnitude, magnitude);
    state.qd[i] = random->Uniform(-magnitude, magnitude);
  }
  return state;
}

MeasuredFrame Measure(const PendulumState<double>& state) {
  return {HipPosition(kBody, state.q), state};
}

// The sum of absolute errors, of the rate of phi itself and of the rod, by hand. Of the measured
// rate of phi nothing is asked.
TEST(FrameResidual, LdpsLossIsItsEquation6) {
  PendulumState<double> state;
  MeasuredFrame measured = Measure(state);
  measured.state.qd[3] = 5.0;
  measured.rod = -0.02;
  state.q << 0.3, -0.2, 0.4, -0.5;
  state.qd << 1.0, -2.0, 0.5, -0.7;
  state.rod = 0.03;
  const double sum = 0.3 + 0.2 + 0.4 + 0.5 + 1.0 + 2.0 + 0.5 + 0.3 * 0.7 + 0.05;
  const double cost = 0.5 * FrameResidual(kBody, state, measured, kLdpSigmas).squaredNorm();
  // Beyond the kink: d |r| - d^2 for each of the nine.
  EXPECT_NEAR(cost, 0.01 * sum / 0.1 - 9 * 1e-4, 1e-4);
}

TEST(FrameResidual, IsInSigmasAndInOrder) {
  const ResidualSigmas sigmas{0.2, 0.5, 0.1, 2.0, 0.0};
  PendulumState<double> state;
  MeasuredFrame measured = Measure(state);
  measured.hip -= Vector3<double>(0.2, 0.4, 0.6);
  state.qd << 0.5, 1.0, 2.0, 4.0;
  measured.state.q.tail<2>() << -0.1, -0.2;
  FrameVector<double> expected;
  expected << 1, 2, 3, 1, 2, 1, 2, 1, 2;
  EXPECT_LT((FrameResidual(kBody, state, measured, sigmas) - expected).norm(), 1e-14);
}

// Half the squared norm is the pseudo-Huber cost d^2 (sqrt(1 + s / d^2) - 1) of the raw residual.
TEST(FrameResidual, RobustCostIsPseudoHuber) {
  Random random(22);
  for (double d : {0.3, 1.0, 5.0}) {
    for (double magnitude : {1e-8, 0.1, 1.2}) {
      ResidualSigmas sigmas;
      sigmas.robust = d;
      const PendulumState<double> state = UniformState(magnitude, &random);
      const MeasuredFrame measured = Measure(UniformState(magnitude, &random));
      const double s =
          RawFrameResidual(kBody, state, Angles<double>(state.q), measured, sigmas).squaredNorm();
      const double cost = 0.5 * FrameResidual(kBody, state, measured, sigmas).squaredNorm();
      // (sqrt(1 + x) - 1) without its cancellation.
      const double x = s / (d * d);
      EXPECT_NEAR(cost, d * d * x / (std::sqrt(1.0 + x) + 1.0), 1e-13 * cost);
      EXPECT_LE(cost, 0.5 * s);
    }
  }
}

TEST(FrameResidual, WithoutRobustScaleItIsPlain) {
  Random random(23);
  ResidualSigmas sigmas;
  sigmas.robust = 0.0;
  const PendulumState<double> state = UniformState(1.0, &random);
  const MeasuredFrame measured = Measure(UniformState(1.0, &random));
  EXPECT_EQ(FrameResidual(kBody, state, measured, sigmas),
            RawFrameResidual(kBody, state, Angles<double>(state.q), measured, sigmas));
  sigmas.robust = 1e9;  // so wide a scale is plain least squares too
  const FrameVector<double> wide = FrameResidual(kBody, state, measured, sigmas);
  EXPECT_LT(
      (wide - RawFrameResidual(kBody, state, Angles<double>(state.q), measured, sigmas)).norm(),
      1e-12);
}

// A frame's weight scales what it contributes, after the robust weight; at 0 nothing is left.
TEST(FrameResidual, WeightOfTheFrame) {
  Random random(24);
  for (double robust : {0.0, 0.5}) {
    ResidualSigmas sigmas;
    sigmas.robust = robust;
    const PendulumState<double> state = UniformState(1.0, &random);
    MeasuredFrame measured = Measure(UniformState(1.0, &random));
    const FrameVector<double> full = FrameResidual(kBody, state, measured, sigmas);
    measured.weight = 0.25;
    EXPECT_LT((FrameResidual(kBody, state, measured, sigmas) - 0.25 * full).norm(), 1e-15);
    measured.weight = 0.0;
    EXPECT_TRUE(FrameResidual(kBody, state, measured, sigmas).isZero(0.0));
  }
}

// The corrected rows' J'J is the Hessian of the robust cost, where the residual itself is linear.
TEST(RobustLoss, CorrectedRowsHaveItsHessian) {
  constexpr double kRobust = 1.3, kWeight = 0.7;
  using Jet = ceres::Jet<double, 2>;
  Random random(5);
  for (double size : {0.1, 1.0, 8.0}) {
    SCOPED_TRACE(size);
    FrameVector<double> offset;
    Eigen::Matrix<double, kFrameResiduals, 2> slope;
    for (int row = 0; row < kFrameResiduals; ++row) {
      offset[row] = size * random.Uniform(-1.0, 1.0);
      for (int k = 0; k < 2; ++k) slope(row, k) = random.Uniform(-1.0, 1.0);
    }
    const auto residual_at = [&](const Eigen::Vector2d& at) {
      FrameVector<Jet> r;
      for (int row = 0; row < kFrameResiduals; ++row) {
        r[row] = Jet(offset[row]) + slope(row, 0) * Jet(at[0], 0) + slope(row, 1) * Jet(at[1], 1);
      }
      const FrameVector<Jet> weighted =
          Jet(kWeight) * RobustWeight<Jet>(r.squaredNorm(), kRobust) * r;
      return weighted;
    };
    const auto gradient_at = [&](const Eigen::Vector2d& at) {
      Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
      const FrameVector<Jet> r = residual_at(at);
      for (int row = 0; row < kFrameResiduals; ++row) gradient += r[row].a * r[row].v;
      return gradient;
    };
    Eigen::Matrix2d expected;
    constexpr double kStep = 1e-5;
    for (int k = 0; k < 2; ++k) {
      const Eigen::Vector2d step = kStep * Eigen::Vector2d::Unit(k);
      expected.col(k) = (gradient_at(step) - gradient_at(-step)) / (2.0 * kStep);
    }
    const FrameVector<Jet> here = residual_at(Eigen::Vector2d::Zero());
    FrameVector<double> value;
    Eigen::Matrix<double, kFrameResiduals, 2> jacobian;
    for (int row = 0; row < kFrameResiduals; ++row) {
      value[row] = here[row].a;
      jacobian.row(row) = here[row].v.transpose();
    }
    CorrectForRobustLoss(value, kWeight, kRobust, jacobian);
    const Eigen::Matrix2d found = jacobian.transpose() * jacobian;
    EXPECT_LT((found - expected).norm(), 1e-6 * expected.norm());
  }
}

}  // namespace
}  // namespace pushid
