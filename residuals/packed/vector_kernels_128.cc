// residuals: kernels for what every processor of 64 bits has.
#define PUSHID_VECTOR_NAME "128-bit vectors"
#define PUSHID_VECTOR_DOUBLES 2
#define PUSHID_TILE_VECTORS 2
#define PUSHID_TILE_COLUMNS 4
#include "residuals/packed/vector_kernels_loops.h"

namespace pushid {

const VectorKernels* Vectors128() { return &kKernels; }

}  // namespace pushid
