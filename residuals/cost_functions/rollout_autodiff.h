// residuals: the two ways to the Jacobian of a recording's residual.
#pragma once

#include <ceres/cost_function.h>

#include <memory>

#include "residuals/cost_functions/rollout_residual.h"
#include "residuals/jacobian_method.h"

namespace pushid {

std::unique_ptr<ceres::CostFunction> MakeRolloutCost(std::shared_ptr<const RolloutProblem> problem,
                                                     JacobianMethod method);

}  // namespace pushid
