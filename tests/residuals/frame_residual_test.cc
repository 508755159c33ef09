// One frame's residual: the analytic twin, and the robust weight.
#include "residuals/frame_residual.h"

#include <ceres/jet.h>

#include "tests/residuals/residual_samples.h"

namespace pushid {
namespace {

const Body kBody{72.0, 0.93, 0.08};

PendulumState<double> RandomState(double magnitude, Random* random) {
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

void ExpectTwins(const PendulumState<double>& state, const MeasuredFrame& measured,
                 const ResidualSigmas& sigmas) {
  using Jet = ceres::Jet<double, 8>;
  PendulumState<Jet> jets;
  for (int i = 0; i < 4; ++i) {
    jets.q[i] = Jet(state.q[i], i);
    jets.qd[i] = Jet(state.qd[i], 4 + i);
  }
  const FrameVector<Jet> expected = FrameResidual(kBody, jets, measured, sigmas);
  Eigen::Matrix<double, kFrameResiduals, 8> jacobian;
  jacobian.setConstant(std::nan(""));
  const FrameVector<double> r =
      FrameResidualWithJacobian(kBody, state, measured, sigmas, &jacobian);
  const FrameVector<double> plain = FrameResidual(kBody, state, measured, sigmas);
  for (int row = 0; row < kFrameResiduals; ++row) {
    const double scale = std::max(1.0, std::abs(r[row]));
    EXPECT_NEAR(r[row], expected[row].a, 1e-15 * scale);
    EXPECT_NEAR(r[row], plain[row], 1e-15 * scale);
    for (int column = 0; column < 8; ++column) {
      const double value = expected[row].v[column];
      EXPECT_NEAR(jacobian(row, column), value, 1e-12 * std::max(1.0, std::abs(value)))
          << "row " << row << ", column " << column;
    }
  }
}

class FrameTwins : public testing::TestWithParam<double> {};  // the robust scale

TEST_P(FrameTwins, AgreeInThreeRegimes) {
  Random random(21);
  ResidualSigmas sigmas;
  sigmas.robust = GetParam();
  const PendulumState<double> rest;
  ExpectTwins(rest, Measure(rest), sigmas);
  for (double magnitude : {1e-8, 1.2}) {
    SCOPED_TRACE(magnitude);
    for (int i = 0; i < 50; ++i) {
      MeasuredFrame measured = Measure(RandomState(magnitude, &random));
      measured.weight = i % 3 == 0 ? 1.0 : random.Uniform(0.0, 1.0);
      measured.hip += Vector3<double>(0.02, -0.01, 0.03) * magnitude;
      ExpectTwins(RandomState(magnitude, &random), measured, sigmas);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(PlainAndRobust, FrameTwins, testing::Values(0.0, 0.3, 1.0, 10.0));

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
      const PendulumState<double> state = RandomState(magnitude, &random);
      const MeasuredFrame measured = Measure(RandomState(magnitude, &random));
      const double s = RawFrameResidual(kBody, state, measured, sigmas).squaredNorm();
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
  const PendulumState<double> state = RandomState(1.0, &random);
  const MeasuredFrame measured = Measure(RandomState(1.0, &random));
  EXPECT_EQ(FrameResidual(kBody, state, measured, sigmas),
            RawFrameResidual(kBody, state, measured, sigmas));
  sigmas.robust = 1e9;  // so wide a scale is plain least squares too
  const FrameVector<double> wide = FrameResidual(kBody, state, measured, sigmas);
  EXPECT_LT((wide - RawFrameResidual(kBody, state, measured, sigmas)).norm(), 1e-12);
}

// A frame's weight scales what it contributes, after the robust weight; at 0 nothing is left.
TEST(FrameResidual, WeightOfTheFrame) {
  Random random(24);
  for (double robust : {0.0, 0.5}) {
    ResidualSigmas sigmas;
    sigmas.robust = robust;
    const PendulumState<double> state = RandomState(1.0, &random);
    MeasuredFrame measured = Measure(RandomState(1.0, &random));
    const FrameVector<double> full = FrameResidual(kBody, state, measured, sigmas);
    measured.weight = 0.25;
    EXPECT_LT((FrameResidual(kBody, state, measured, sigmas) - 0.25 * full).norm(), 1e-15);
    measured.weight = 0.0;
    Eigen::Matrix<double, kFrameResiduals, 8> jacobian;
    jacobian.setConstant(std::nan(""));
    EXPECT_TRUE(FrameResidualWithJacobian(kBody, state, measured, sigmas, &jacobian).isZero(0.0));
    EXPECT_TRUE(jacobian.isZero(0.0));
  }
}

}  // namespace
}  // namespace pushid
