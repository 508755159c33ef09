// models: a product by tiles of 16 rows and 6 columns, whose sums stay in registers.
#include "models/restoration/float_product.h"

#include <algorithm>
#include <cstring>

namespace pushid {

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
namespace {

constexpr int kRows = 16, kColumns = 6;
typedef float Vector __attribute__((vector_size(kRows * sizeof(float))));

// The tiles of some rows of a product, whose columns are `stride` apart:
//
//   to(i, j) = sum over k of left[kRows * k + i] right(k, j), i < rows, j < columns
//
// right by columns, `depth` long.
#define PUSHID_TILES_OF(name, isa)                                                            \
  __attribute__((target(isa))) void name(Eigen::Index depth, const float* left,               \
                                         const float* right, Eigen::Index columns,            \
                                         Eigen::Index rows, Eigen::Index stride, float* to) { \
    for (Eigen::Index first = 0; first < columns; first += kColumns) {                        \
      const float* column[kColumns];                                                          \
      for (Eigen::Index j = 0; j < kColumns; ++j) {                                           \
        column[j] = right + depth * std::min(first + j, columns - 1);                         \
      }                                                                                       \
      Vector sums[kColumns] = {};                                                             \
      for (Eigen::Index k = 0; k < depth; ++k) {                                              \
        Vector of_left;                                                                       \
        std::memcpy(&of_left, left + kRows * k, sizeof(of_left));                             \
        _Pragma("GCC unroll 6") for (int j = 0; j < kColumns; ++j) {                          \
          sums[j] += of_left * column[j][k];                                                  \
        }                                                                                     \
      }                                                                                       \
      const Eigen::Index count = std::min<Eigen::Index>(kColumns, columns - first);           \
      for (Eigen::Index j = 0; j < count; ++j) {                                              \
        float* const column_of = to + stride * (first + j);                                   \
        if (rows == kRows) {                                                                  \
          std::memcpy(column_of, &sums[j], sizeof(Vector));                                   \
        } else {                                                                              \
          std::memcpy(column_of, &sums[j], static_cast<size_t>(rows) * sizeof(float));        \
        }                                                                                     \
      }                                                                                       \
    }                                                                                         \
  }
PUSHID_TILES_OF(Tiles512, "avx512f")
PUSHID_TILES_OF(Tiles256, "avx2,fma")
#undef PUSHID_TILES_OF

using Tiles = decltype(&Tiles256);

Tiles Widest() {
  if (__builtin_cpu_supports("avx512f")) return Tiles512;
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return Tiles256;
  return nullptr;
}

}  // namespace

Eigen::MatrixXf FloatProduct(const Eigen::MatrixXf& a, const Eigen::MatrixXf& b) {
  static const Tiles tiles = Widest();
  const Eigen::Index depth = a.cols(), columns = b.cols();
  if (tiles == nullptr || columns < kColumns) return a * b;
  Eigen::MatrixXf product(a.rows(), columns);
  Eigen::MatrixXf left = Eigen::MatrixXf::Zero(kRows, depth);
  for (Eigen::Index row = 0; row < a.rows(); row += kRows) {
    const Eigen::Index count = std::min<Eigen::Index>(kRows, a.rows() - row);
    left.topRows(count) = a.middleRows(row, count);
    tiles(depth, left.data(), b.data(), columns, count, a.rows(), &product(row, 0));
  }
  return product;
}

#else

Eigen::MatrixXf FloatProduct(const Eigen::MatrixXf& a, const Eigen::MatrixXf& b) { return a * b; }

#endif

}  // namespace pushid
