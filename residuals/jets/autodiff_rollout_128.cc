// residuals: rollouts by jets for what every processor of the build has.
#if defined(__AVX512F__)
#define PUSHID_VECTOR_DOUBLES 8
#elif defined(__AVX__)
#define PUSHID_VECTOR_DOUBLES 4
#else
#define PUSHID_VECTOR_DOUBLES 2
#endif
#include "residuals/jets/autodiff_rollout_loops.h"

namespace pushid {

const RolloutJets* RolloutJets128() {
  static constexpr RolloutJets jets = OfWidth("128-bit vectors");
  return &jets;
}

}  // namespace pushid
