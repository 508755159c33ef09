// The hinge on the free modes: silent where they decay, growing where they do not, differentiable.
#include "residuals/cost_functions/rest_residual.h"
#include "tests/residuals/residual_samples.h"

namespace pushid {
namespace {

const Body kBody{80.0, 0.95, 0.0};

ParameterSet<double> Steady() {
  ParameterSet<double> p{};
  p[kMu] = p[kMuY] = 40.0, p[kKpTheta] = p[kKpPhi] = 1800.0, p[kKdTheta] = p[kKdPhi] = 80.0;
  p[kAx] = -5.0, p[kTailTime] = 0.2;
  return p;
}

Eigen::VectorXd Residuals(const ParameterSet<double>& p, double margin) {
  ParameterMap map;
  map.values = p;
  map.fitted = {{kMu, Transform::kIdentity, -1}};
  return EvaluateCost(ModalStabilityResidual({}, kBody, map, margin, 10.0), {{p[kMu]}}, {})
      .residuals;
}

TEST(ModalStabilityResidual, JacobianAgainstNumericDifferentiation) {
  Random random(61);
  const ParameterMap map = EveryParameterMap({});
  for (double spread : {0.0, 1e-8, 0.4}) {
    for (double margin : {0.0, 2.0}) {
      const ModalStabilityResidual cost({}, kBody, map, margin, 10.0);
      ASSERT_EQ(cost.num_residuals(), ModalStabilityResidual::kResiduals);
      ExpectCorrectJacobian(cost, {SharedBlock(map, RandomRecoveringParameters(&random, spread))},
                            {1e-6, 1e-8, 1e-14});
    }
  }
}

TEST(ModalStabilityResidual, OfAUnit) {
  Random random(62);
  const ParameterMap map = EveryParameterMap({kMu, kKpTheta, kBx});
  const ModalStabilityResidual cost({}, kBody, map, 2.0, 10.0, true);
  ASSERT_EQ(cost.parameter_block_sizes(), (std::vector<int>{kNumParameters, 3}));
  ExpectCorrectJacobian(
      cost, {SharedBlock(map, RandomRecoveringParameters(&random, 0.2)), {0.1, -0.2, 0.3}},
      {1e-6, 1e-8, 1e-14});
}

// Sideways as forwards: values that follow a fitted one move with it.
TEST(ModalStabilityResidual, OthersOfTheSameValue) {
  Random random(63);
  ParameterMap map = EveryParameterMap({kKpTheta});
  map.fitted = {{kMu, Transform::kIdentity, -1, kMuY}, {kKpTheta, Transform::kLog, 0, kKpPhi}};
  const ModalStabilityResidual cost({}, kBody, map, 2.0, 10.0, true);
  const ParameterSet<double> p = RandomRecoveringParameters(&random, 0.2);
  ExpectCorrectJacobian(cost, {{p[kMu], std::log(p[kKpTheta])}, {0.1}}, {1e-6, 1e-8, 1e-14});
}

TEST(ModalStabilityResidual, SilentWhereEveryModeDecays) {
  EXPECT_LT(Residuals(Steady(), 0.0).maxCoeff(), 0.01);
}

TEST(ModalStabilityResidual, SpeaksWhereAModeGrowsOrIsTooSlow) {
  ParameterSet<double> p = Steady();
  p[kBx] = -2.0;  // leaning faster drives the cart backwards
  EXPECT_GT(Residuals(p, 0.0).maxCoeff(), 1.0);
  p = Steady();
  p[kMuY] = p[kMu] = -20.0;
  EXPECT_GT(Residuals(p, 0.0).maxCoeff(), 0.1);
  EXPECT_GT(Residuals(Steady(), 3.0).maxCoeff(), 0.1);
}

}  // namespace
}  // namespace pushid
