// residuals: which likelihood of the recordings a fit maximizes.
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

}  // namespace pushid
