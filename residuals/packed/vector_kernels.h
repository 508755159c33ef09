// residuals: the inner loops of packed networks (packed_network.h) and of normal equations
// (normal_equations.h), once for each width of vectors that processors have, and the choice of the
// widest at run time.
//
// Releases are built for any x86-64, where Eigen's own products have 128-bit vectors and no fused
// multiply-add, and its tanh of doubles no vectors at all. For 1024 x 290 times 290 x 32 on one
// core with AVX-512: Eigen 20 Gflop/s, these loops about 100. Rejected: a BLAS, since which one a
// machine has is chance (there, Debian's reference BLAS 8, its ATLAS 22), and -march=native, whose
// Eigen must not meet the packaged Ceres'. Another width rounds otherwise: results repeat bit by
// bit on one machine, and to rounding across.
#pragma once

#include <cstddef>
#include <vector>

namespace pushid {

inline constexpr int kGramBlock = 8;  // columns: a whole number of vectors of every width

struct VectorKernels {
  const char* name;
  int tile_rows, tile_columns;
  // c(i, j) += sum over k of left[k * tile_rows + i] right[k * tile_columns + j], for one tile;
  // c by columns, `stride` apart.
  void (*add_tile)(int depth, const double* left, const double* right, double* c,
                   std::ptrdiff_t stride);
  // sum += factors' a, a by rows, `stride` apart; columns: a multiple of kGramBlock.
  void (*add_rows)(int rows, std::ptrdiff_t columns, const double* factors, const double* a,
                   std::ptrdiff_t a_stride, double* sum);
  // g += a' a by rows, `stride` apart; columns: a multiple of kGramBlock. What lies left of a
  // diagonal block is not touched.
  void (*add_gram)(int rows, std::ptrdiff_t columns, const double* a, std::ptrdiff_t a_stride,
                   double* g, std::ptrdiff_t g_stride);
  // In place; to about two units in the last place, of tanh near zero too.
  void (*tanh)(double* values, std::ptrdiff_t count);
  void (*logistic)(double* values, std::ptrdiff_t count);
};

// What this processor can run, the widest last; never empty.
const std::vector<const VectorKernels*>& SupportedVectorKernels();

const VectorKernels& BestVectorKernels();

// One file each, compiled for its instructions; null where the compiler has none such.
const VectorKernels* Vectors128();
const VectorKernels* Vectors256();  // AVX2 and FMA
const VectorKernels* Vectors512();  // AVX-512F and DQ

}  // namespace pushid
