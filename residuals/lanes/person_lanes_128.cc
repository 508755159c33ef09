// residuals: people side by side for what every processor of 64 bits has.
#define PUSHID_VECTOR_DOUBLES 2
#include "residuals/lanes/person_lanes_loops.h"

namespace pushid {

const PersonLanes* PersonLanes128() {
  static constexpr PersonLanes lanes = {"128-bit vectors", kWidth, RollLanes};
  return &lanes;
}

}  // namespace pushid
