// residuals: people side by side for AVX-512.
#include "residuals/lanes/person_lanes.h"

#if defined(__AVX512F__) && defined(__AVX512DQ__)
#define PUSHID_VECTOR_DOUBLES 8
#include "residuals/lanes/person_lanes_loops.h"

namespace pushid {

const PersonLanes* PersonLanes512() {
  static constexpr PersonLanes lanes = {"512-bit vectors", kWidth, RollLanes};
  return &lanes;
}

}  // namespace pushid
#else
namespace pushid {

const PersonLanes* PersonLanes512() { return nullptr; }

}  // namespace pushid
#endif
