// residuals: people side by side for what every processor of 64 bits has.
#define PUSHID_VECTOR_NAME "128-bit vectors"
#define PUSHID_VECTOR_DOUBLES 2
#include "residuals/lanes/person_lanes_loops.h"

namespace pushid {

const PersonLanes* PersonLanes128() { return &kPersonLanes; }

}  // namespace pushid
