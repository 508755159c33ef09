// residuals: the choice among the vector kernels.
#include "residuals/packed/vector_kernels.h"

namespace pushid {
namespace {

bool HasAvx2() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
  return false;
#endif
}

bool HasAvx512() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq");
#else
  return false;
#endif
}

std::vector<const VectorKernels*> Supported() {
  std::vector<const VectorKernels*> kernels = {Vectors128()};
  if (HasAvx2() && Vectors256() != nullptr) kernels.push_back(Vectors256());
  if (HasAvx512() && Vectors512() != nullptr) kernels.push_back(Vectors512());
  return kernels;
}

}  // namespace

const std::vector<const VectorKernels*>& SupportedVectorKernels() {
  static const std::vector<const VectorKernels*> kernels = Supported();
  return kernels;
}

const VectorKernels& BestVectorKernels() { return *SupportedVectorKernels().back(); }

}  // namespace pushid
