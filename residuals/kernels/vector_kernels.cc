// residuals: what the processor has.
#include "residuals/kernels/vector_kernels.h"

namespace pushid {

int NumVectorWidths() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") ? 3 : 2;
  }
#endif
  return 1;
}

}  // namespace pushid
