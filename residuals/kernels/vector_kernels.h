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

// The kernels, lanes (lanes/person_lanes.h) or jets (jets/autodiff_rollout.h) for vectors of so
// many bits, each compiled for its instructions (CMakeLists.txt): 256 have AVX2 and FMA, 512
// AVX-512F and DQ.
template <typename Code, int kBits>
const Code& OfWidth();
#define PUSHID_WIDTHS(Code)         \
  template <>                       \
  const Code& OfWidth<Code, 128>(); \
  template <>                       \
  const Code& OfWidth<Code, 256>(); \
  template <>                       \
  const Code& OfWidth<Code, 512>()
PUSHID_WIDTHS(VectorKernels);

// The widths among 128, 256 and 512 bits that this processor can run.
int NumVectorWidths();

// All widths that this processor can run, the widest last; never empty.
template <typename Code>
const std::vector<const Code*>& Supported() {
  static const std::vector<const Code*> supported = [] {
    std::vector<const Code*> all = {&OfWidth<Code, 128>()};
#if defined(__x86_64__)
    if (NumVectorWidths() > 1) all.push_back(&OfWidth<Code, 256>());
    if (NumVectorWidths() > 2) all.push_back(&OfWidth<Code, 512>());
#endif
    return all;
  }();
  return supported;
}
template <typename Code>
const Code& Widest() {
  return *Supported<Code>().back();
}

}  // namespace pushid
