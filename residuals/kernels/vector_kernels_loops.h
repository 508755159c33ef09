// residuals: the loops of vector_kernels.h, for the file of each width (CMakeLists.txt), which
// gives Eigen's namespace a name of its own: nothing here may be shared with files compiled for
// other instructions, hence no inline function of other headers and no external linkage.
#pragma once

// Small products coefficient by coefficient would round as their operands happen to lie in memory.
#define EIGEN_GEMM_TO_COEFFBASED_THRESHOLD 1
#include <Eigen/Core>

#include "residuals/kernels/vector_kernels.h"

namespace pushid {
namespace {

using Vector = double __attribute__((vector_size(8 * PUSHID_VECTOR_DOUBLES)));

Vector Load(const double* from) {
  Vector vector;
  __builtin_memcpy(&vector, from, sizeof(vector));
  return vector;
}

template <int kLeft, int kRight>
void AddInOrder(const MatrixAt& left, const MatrixAt& right, double* sum, std::ptrdiff_t stride) {
  using Eigen::Dynamic, Eigen::OuterStride;
  using Left = Eigen::Matrix<double, Dynamic, Dynamic, kLeft>;
  using Right = Eigen::Matrix<double, Dynamic, Dynamic, kRight>;
  Eigen::Map<Eigen::MatrixXd, 0, OuterStride<>>(sum, left.rows, right.columns,
                                                OuterStride<>(stride))
      .noalias() += Eigen::Map<const Left, 0, OuterStride<>>(left.values, left.rows, left.columns,
                                                             OuterStride<>(left.stride)) *
                    Eigen::Map<const Right, 0, OuterStride<>>(
                        right.values, right.rows, right.columns, OuterStride<>(right.stride));
}

void AddProduct(const MatrixAt& left, const MatrixAt& right, double* sum, std::ptrdiff_t stride) {
  using Eigen::ColMajor, Eigen::RowMajor;
  if (left.rows == 1 && right.columns == 1) {  // so would Eigen's dot product
    const std::ptrdiff_t from = left.by_rows ? 1 : left.stride,
                         with = right.by_rows ? right.stride : 1;
    for (std::ptrdiff_t k = 0; k < left.columns; ++k) {
      *sum += left.values[k * from] * right.values[k * with];
    }
    return;
  }
  const auto add =
      left.by_rows
          ? (right.by_rows ? AddInOrder<RowMajor, RowMajor> : AddInOrder<RowMajor, ColMajor>)
          : (right.by_rows ? AddInOrder<ColMajor, RowMajor> : AddInOrder<ColMajor, ColMajor>);
  add(left, right, sum, stride);
}

void AddRows(int rows, std::ptrdiff_t columns, const double* factors, const double* a,
             std::ptrdiff_t a_stride, double* sum) {
  for (std::ptrdiff_t at = 0; at < columns; at += PUSHID_VECTOR_DOUBLES) {
    Vector added = Load(sum + at);
    for (int k = 0; k < rows; ++k) added += Load(a + k * a_stride + at) * factors[k];
    __builtin_memcpy(sum + at, &added, sizeof(Vector));
  }
}

// kGramBlock rows of g, from its block on the diagonal to the right, a vector at a time.
void AddGram(int rows, std::ptrdiff_t columns, const double* a, std::ptrdiff_t a_stride, double* g,
             std::ptrdiff_t g_stride) {
  for (std::ptrdiff_t first = 0; first < columns; first += kGramBlock) {
    for (std::ptrdiff_t at = first; at < columns; at += PUSHID_VECTOR_DOUBLES) {
      double* const to = g + first * g_stride + at;
      Vector sums[kGramBlock];
#pragma GCC unroll 8
      for (int r = 0; r < kGramBlock; ++r) sums[r] = Load(to + r * g_stride);
      for (int k = 0; k < rows; ++k) {
        const double* const row = a + k * a_stride;
        const Vector right = Load(row + at);
#pragma GCC unroll 8
        for (int r = 0; r < kGramBlock; ++r) sums[r] += right * row[first + r];
      }
#pragma GCC unroll 8
      for (int r = 0; r < kGramBlock; ++r) {
        __builtin_memcpy(to + r * g_stride, &sums[r], sizeof(Vector));
      }
    }
  }
}

}  // namespace

template <>
const VectorKernels& OfWidth<VectorKernels, PUSHID_WIDTH>() {
  static constexpr VectorKernels kernels = {PUSHID_WIDTH, AddProduct, AddRows, AddGram};
  return kernels;
}

}  // namespace pushid
