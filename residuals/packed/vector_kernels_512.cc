// residuals: kernels for AVX-512.
#include "residuals/packed/vector_kernels.h"

#if defined(__AVX512F__) && defined(__AVX512DQ__)
#define PUSHID_VECTOR_NAME "512-bit vectors"
#define PUSHID_VECTOR_DOUBLES 8
#define PUSHID_TILE_VECTORS 3
#define PUSHID_TILE_COLUMNS 8
#include "residuals/packed/vector_kernels_loops.h"

namespace pushid {

const VectorKernels* Vectors512() { return &kKernels; }

}  // namespace pushid
#else
namespace pushid {

const VectorKernels* Vectors512() { return nullptr; }

}  // namespace pushid
#endif
