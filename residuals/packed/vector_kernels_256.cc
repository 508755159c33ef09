// residuals: kernels for AVX2 and FMA.
#include "residuals/packed/vector_kernels.h"

#if defined(__AVX2__) && defined(__FMA__)
#define PUSHID_VECTOR_NAME "256-bit vectors"
#define PUSHID_VECTOR_DOUBLES 4
#define PUSHID_TILE_VECTORS 3
#define PUSHID_TILE_COLUMNS 4
#include "residuals/packed/vector_kernels_loops.h"

namespace pushid {

const VectorKernels* Vectors256() { return &kKernels; }

}  // namespace pushid
#else
namespace pushid {

const VectorKernels* Vectors256() { return nullptr; }

}  // namespace pushid
#endif
