// The oracle of the sensitivities.
#include "tests/residuals/rollout_by_jets.h"

#include <ceres/dynamic_autodiff_cost_function.h>

namespace pushid {

std::unique_ptr<ceres::CostFunction> RolloutByJets(std::shared_ptr<const RolloutProblem> problem) {
  constexpr int kStride = 8;  // columns per sweep: seven parameters, the default fit's, take one
  using Cost = ceres::DynamicAutoDiffCostFunction<RolloutResidualFunctor, kStride>;
  auto cost = std::make_unique<Cost>(new RolloutResidualFunctor{problem});
  for (int size : problem->layout.BlockSizes()) cost->AddParameterBlock(size);
  cost->SetNumResiduals(problem->num_residuals());
  return cost;
}

}  // namespace pushid
