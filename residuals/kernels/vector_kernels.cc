// residuals: the choice among the vector kernels.
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

const std::vector<const VectorKernels*>& SupportedVectorKernels() {
  static const std::vector<const VectorKernels*> supported = [] {
    std::vector<const VectorKernels*> all = PUSHID_OF_WIDTHS(VectorKernelsOf);
    all.resize(NumVectorWidths());
    return all;
  }();
  return supported;
}

const VectorKernels& BestVectorKernels() { return *SupportedVectorKernels().back(); }

}  // namespace pushid
