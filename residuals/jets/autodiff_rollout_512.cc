// residuals: rollouts by jets for AVX-512.
#include "residuals/jets/autodiff_rollout.h"

#if defined(PUSHID_WIDER_JETS) && defined(__AVX512F__) && defined(__AVX512DQ__)
#define PUSHID_VECTOR_DOUBLES 8
#include "residuals/jets/autodiff_rollout_loops.h"

namespace pushid {

const RolloutJets* RolloutJets512() {
  static constexpr RolloutJets jets = OfWidth("512-bit vectors");
  return &jets;
}

}  // namespace pushid
#else
namespace pushid {

const RolloutJets* RolloutJets512() { return nullptr; }

}  // namespace pushid
#endif
