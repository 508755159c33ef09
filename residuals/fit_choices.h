// residuals: which likelihood of the recordings a fit maximizes.
#pragma once

#include "models/enum_names.h"

namespace pushid {

enum class Likelihood {
  kTrajectory,  // of whole rollouts from frame 0 (cost_functions/rollout_problem.h): no process
                // noise
  kTransition,  // of every measured state given the one before
  kInnovation   // of every measurement given all before it
};
constexpr EnumNames<Likelihood, 3> Names(Likelihood) {
  return {{{"trajectory", Likelihood::kTrajectory},
           {"transition", Likelihood::kTransition},
           {"innovation", Likelihood::kInnovation}}};
}

}  // namespace pushid
