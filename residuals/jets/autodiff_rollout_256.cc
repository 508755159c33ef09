// residuals: rollouts by jets for AVX2.
#include "residuals/jets/autodiff_rollout.h"

#if defined(PUSHID_WIDER_JETS) && defined(__AVX2__)
#define PUSHID_VECTOR_DOUBLES 4
#include "residuals/jets/autodiff_rollout_loops.h"

namespace pushid {

const RolloutJets* RolloutJets256() {
  static constexpr RolloutJets jets = OfWidth("256-bit vectors");
  return &jets;
}

}  // namespace pushid
#else
namespace pushid {

const RolloutJets* RolloutJets256() { return nullptr; }

}  // namespace pushid
#endif
