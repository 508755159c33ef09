// residuals: the two ways to the Jacobian of a recording's residual.
#pragma once

#include <ceres/cost_function.h>

#include <memory>
#include <string_view>
#include <utility>

#include "models/enum_names.h"
#include "residuals/cost_functions/rollout_residual.h"

namespace pushid {

enum class JacobianMethod {
  kSensitivities,  // chained step by step (rollout_sensitivities.h): RolloutResidual
  kAutodiff        // Jets through the whole rollout by Ceres: the oracle, at a user's hand, to rule
                   // out an error in the chain; slower, and slower still with many parameters
};
constexpr EnumNames<JacobianMethod, 2> Names(JacobianMethod) {
  return {{{"sensitivities", JacobianMethod::kSensitivities}, {"autodiff", JacobianMethod::kAutodiff}}};
}

std::unique_ptr<ceres::CostFunction> MakeRolloutCost(std::shared_ptr<const RolloutProblem> problem,
                                                     JacobianMethod method);

}  // namespace pushid
