// residuals: the loops of vector_kernels.h, for the file that includes this, which says
//   PUSHID_VECTOR_DOUBLES      doubles in a vector (vector_math.h)
//   PUSHID_TILE_VECTORS        vectors in a tile's column
//   PUSHID_TILE_COLUMNS        columns of a tile; all of it must fit into the registers
// Nothing here may be shared with files compiled for other instructions, hence no inline function
// of any header and no external linkage.
#pragma once

#include "residuals/packed/vector_kernels.h"
#include "residuals/packed/vector_math.h"

namespace pushid {
namespace {

constexpr int kTileRows = PUSHID_VECTOR_DOUBLES * PUSHID_TILE_VECTORS;

// Every loop over the sums is unrolled, or else they would live in memory.
void AddTile(int depth, const double* left, const double* right, double* c, std::ptrdiff_t stride) {
  Vector sums[PUSHID_TILE_COLUMNS][PUSHID_TILE_VECTORS] = {};
  for (int k = 0; k < depth; ++k, left += kTileRows, right += PUSHID_TILE_COLUMNS) {
    Vector column[PUSHID_TILE_VECTORS];
#pragma GCC unroll 16
    for (int v = 0; v < PUSHID_TILE_VECTORS; ++v) {
      column[v] = Load(left + v * PUSHID_VECTOR_DOUBLES);
    }
#pragma GCC unroll 16
    for (int j = 0; j < PUSHID_TILE_COLUMNS; ++j) {
#pragma GCC unroll 16
      for (int v = 0; v < PUSHID_TILE_VECTORS; ++v) sums[j][v] += column[v] * right[j];
    }
  }
#pragma GCC unroll 16
  for (int j = 0; j < PUSHID_TILE_COLUMNS; ++j) {
#pragma GCC unroll 16
    for (int v = 0; v < PUSHID_TILE_VECTORS; ++v) {
      double* to = c + j * stride + v * PUSHID_VECTOR_DOUBLES;
      const Vector sum = Load(to) + sums[j][v];
      __builtin_memcpy(to, &sum, sizeof(sum));
    }
  }
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

inline Vector LogisticOf(Vector x) {
  const Exponential e = Expand(-Clamp(x, 700.0));
  return 1.0 / (1.0 + (e.power + e.power * e.p));
}

template <Vector (*kOf)(Vector)>
void Each(double* values, std::ptrdiff_t count) {
  constexpr std::ptrdiff_t kWidth = PUSHID_VECTOR_DOUBLES;
  std::ptrdiff_t i = 0;
  for (; i + kWidth <= count; i += kWidth) {
    const Vector result = kOf(Load(values + i));
    __builtin_memcpy(values + i, &result, sizeof(result));
  }
  if (i == count) return;
  double rest[kWidth] = {};
  __builtin_memcpy(rest, values + i, (count - i) * sizeof(double));
  const Vector result = kOf(Load(rest));
  __builtin_memcpy(values + i, &result, (count - i) * sizeof(double));
}

constexpr VectorKernels kKernels = {
    PUSHID_VECTOR_NAME, kTileRows,       PUSHID_TILE_COLUMNS, AddTile, AddRows, AddGram,
    Each<TanhOf>,       Each<LogisticOf>};

}  // namespace
}  // namespace pushid
