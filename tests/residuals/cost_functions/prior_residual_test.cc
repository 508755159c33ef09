// Priors: one residual on one entry of a block.
#include "residuals/cost_functions/prior_residual.h"

#include "tests/jacobian_check.h"

namespace pushid {
namespace {

TEST(PriorResidual, IsTheDistanceInSigmas) {
  const PriorResidual prior(3, 1, 2.0, 0.5);
  EXPECT_EQ(EvaluateCost(prior, {{9.0, 2.0, 9.0}}, {}).residuals[0], 0.0);
  EXPECT_EQ(EvaluateCost(prior, {{9.0, 3.0, 9.0}}, {}).residuals[0], 2.0);
  EXPECT_EQ(EvaluateCost(prior, {{9.0, 1.5, 9.0}}, {}).residuals[0], -1.0);
}

TEST(PriorResidual, JacobianOfEveryEntry) {
  for (int index = 0; index < 3; ++index) {
    const PriorResidual prior(3, index, 2.0, 0.25);
    for (double magnitude : {0.0, 1e-8, 50.0}) {
      ExpectCorrectJacobian(prior, {{magnitude, -magnitude, 2.0 * magnitude}}, {1e-7, 1e-8, 1e-14});
    }
  }
}

// A network's weights.
TEST(PriorResidual, OfAWholeBlockHasARowForEachEntry) {
  const PriorResidual prior(3, 0, 0.0, 0.5, 3);
  EXPECT_EQ(EvaluateCost(prior, {{1.0, 0.0, -2.0}}, {}).residuals, Eigen::Vector3d(2.0, 0.0, -4.0));
  ExpectCorrectJacobian(prior, {{1.0, 0.0, -2.0}}, {1e-7, 1e-8, 1e-14});
}

}  // namespace
}  // namespace pushid
