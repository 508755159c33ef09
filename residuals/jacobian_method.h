// residuals: the two ways to the Jacobian of a recording's residual
// (cost_functions/rollout_autodiff.h).
#pragma once

#include "models/enum_names.h"

namespace pushid {

enum class JacobianMethod {
  kSensitivities,  // chained step by step (rollout_sensitivities.h): RolloutResidual
  kAutodiff        // Jets through the whole rollout by Ceres: the oracle, at a user's hand, to rule
                   // out an error in the chain; slower, and slower still with many parameters
};
constexpr EnumNames<JacobianMethod, 2> Names(JacobianMethod) {
  return {
      {{"sensitivities", JacobianMethod::kSensitivities}, {"autodiff", JacobianMethod::kAutodiff}}};
}

}  // namespace pushid
