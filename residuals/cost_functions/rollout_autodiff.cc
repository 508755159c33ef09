// residuals: RolloutResidualFunctor as a Ceres autodiff cost function.
#include "residuals/cost_functions/rollout_autodiff.h"

#include <ceres/dynamic_autodiff_cost_function.h>

namespace pushid {
namespace {

// Columns per sweep: seven parameters, the default fit's, take one.
constexpr int kStride = 8;

}  // namespace

std::unique_ptr<ceres::CostFunction> MakeRolloutCost(std::shared_ptr<const RolloutProblem> problem,
                                                     JacobianMethod method) {
  if (method == JacobianMethod::kSensitivities) return std::make_unique<RolloutResidual>(problem);
  using Cost = ceres::DynamicAutoDiffCostFunction<RolloutResidualFunctor, kStride>;
  auto cost = std::make_unique<Cost>(new RolloutResidualFunctor{problem});
  for (int size : problem->layout.BlockSizes()) cost->AddParameterBlock(size);
  cost->SetNumResiduals(problem->num_residuals());
  return cost;
}

}  // namespace pushid
