// residuals: which likelihood of the recordings a fit maximizes, and how rollouts are
// differentiated.
#pragma once

#include "models/enum_names.h"

namespace pushid {

enum class Likelihood {
  kTrajectory,  // of whole rollouts from frame 0 (cost_functions/rollout_problem.h): no process
                // noise
  kTransition,  // of every measured state given the one before
  kTransitionAsPrinted,  // the same as printed, to compare
  kInnovation            // of every measurement given all before it
};
constexpr EnumNames<Likelihood, 4> Names(Likelihood) {
  return {{{"trajectory", Likelihood::kTrajectory},
           {"transition", Likelihood::kTransition},
           {"transition_as_printed", Likelihood::kTransitionAsPrinted},
           {"innovation", Likelihood::kInnovation}}};
}

// The two ways to the Jacobian of a recording's residuals (cost_functions/condensed_rollout.h).
enum class JacobianMethod {
  kSensitivities,  // chained step by step (rollout_sensitivities.h)
  kAutodiff        // Jets through the whole rollout by Ceres: a user's check of the chain; slower,
                   // and slower still with many parameters
};
constexpr EnumNames<JacobianMethod, 2> Names(JacobianMethod) {
  return {
      {{"sensitivities", JacobianMethod::kSensitivities}, {"autodiff", JacobianMethod::kAutodiff}}};
}

}  // namespace pushid
