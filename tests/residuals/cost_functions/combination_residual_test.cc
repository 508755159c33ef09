#include <gtest/gtest.h>

#include <cmath>

#include "residuals/cost_functions/prior_residual.h"

namespace pushid {
namespace {

TEST(CombinationResidual, IsTheSumOverItsSigma) {
  ParameterMap map;
  map.fitted = {{kMu, Transform::kIdentity}, {kKpTheta, Transform::kLog}};
  const CombinationResidual residual(map, {2.0, -0.5}, 3.0, 10.0, 0.1);
  const double shared[] = {7.0, std::log(4.0)};
  const double* blocks[] = {shared};
  double value = std::nan(""), jacobian[] = {std::nan(""), std::nan("")};
  double* jacobians[] = {jacobian};
  ASSERT_TRUE(residual.Evaluate(blocks, &value, jacobians));
  EXPECT_NEAR(value, (2.0 * 7.0 - 0.5 * 4.0 + 3.0 - 10.0) / 0.1, 1e-12);
  EXPECT_NEAR(jacobian[0], 20.0, 1e-12);
  EXPECT_NEAR(jacobian[1], -0.5 * 4.0 / 0.1, 1e-12);
}

}  // namespace
}  // namespace pushid
