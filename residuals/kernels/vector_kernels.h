// residuals: the inner loops of normal equations (normal_equations.h) and of large networks
// (adjoint/batched_networks.h), once for each width of vectors that processors have, and the choice
// of the widest at run time.
//
// Releases are built for any x86-64, where Eigen's products have 128-bit vectors and no fused
// multiply-add: 15 Gflop/s on one core with AVX-512, where the same products reach 60. Rejected: a
// BLAS, since which one a machine has is chance, and -march=native, whose Eigen must not meet the
// packaged Ceres'. Another width rounds otherwise: results repeat bit by bit on one machine, and to
// rounding across.
#pragma once

#include <cstddef>
#include <vector>

namespace pushid {

inline constexpr int kGramBlock = 8;  // columns: a whole number of vectors of every width

// A matrix by columns, or by rows, `stride` apart.
struct MatrixAt {
  const double* values;
  std::ptrdiff_t rows, columns, stride;
  bool by_rows;
};

struct VectorKernels {
  int bits;  // of a vector
  // sum += left right; sum by columns, `stride` apart.
  void (*add_product)(const MatrixAt& left, const MatrixAt& right, double* sum,
                      std::ptrdiff_t stride);
  // sum += factors' a, a by rows, `stride` apart; columns: a multiple of kGramBlock.
  void (*add_rows)(int rows, std::ptrdiff_t columns, const double* factors, const double* a,
                   std::ptrdiff_t a_stride, double* sum);
  // g += a' a by rows, `stride` apart; columns: a multiple of kGramBlock. What lies left of a
  // diagonal block is not touched.
  void (*add_gram)(int rows, std::ptrdiff_t columns, const double* a, std::ptrdiff_t a_stride,
                   double* g, std::ptrdiff_t g_stride);
};

// By the bits of a vector, each compiled for its instructions (CMakeLists.txt).
template <int kBits>
const VectorKernels& VectorKernelsOf();
template <>
const VectorKernels& VectorKernelsOf<128>();
template <>
const VectorKernels& VectorKernelsOf<256>();  // AVX2 and FMA
template <>
const VectorKernels& VectorKernelsOf<512>();  // AVX-512F and DQ

// What this processor can run, the widest last; never empty.
const std::vector<const VectorKernels*>& SupportedVectorKernels();

const VectorKernels& BestVectorKernels();

// Everything that a release has for each width, as VectorKernelsOf; the widest last.
#if defined(__x86_64__)
#define PUSHID_OF_WIDTHS(Of) \
  { &Of<128>(), &Of<256>(), &Of<512>() }
#else
#define PUSHID_OF_WIDTHS(Of) \
  { &Of<128>() }
#endif
// The first of them, as many as this processor can run.
int NumVectorWidths();

}  // namespace pushid
