// residuals: people side by side for AVX2 and FMA.
#include "residuals/lanes/person_lanes.h"

#if defined(__AVX2__) && defined(__FMA__)
#define PUSHID_VECTOR_DOUBLES 4
#include "residuals/lanes/person_lanes_loops.h"

namespace pushid {

const PersonLanes* PersonLanes256() {
  static constexpr PersonLanes lanes = {"256-bit vectors", kWidth, RollLanes};
  return &lanes;
}

}  // namespace pushid
#else
namespace pushid {

const PersonLanes* PersonLanes256() { return nullptr; }

}  // namespace pushid
#endif
