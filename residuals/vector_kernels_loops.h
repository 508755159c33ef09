// residuals: the loops of vector_kernels.h, for the file that includes this, which says
//   PUSHID_VECTOR_DOUBLES      doubles in a vector
//   PUSHID_TILE_VECTORS        vectors in a tile's column
//   PUSHID_TILE_COLUMNS        columns of a tile; all of it must fit into the registers
// Nothing here may be shared with files compiled for other instructions, hence no inline function
// of any header and no external linkage.
#pragma once

#include "residuals/vector_kernels.h"

namespace pushid {
namespace {

using Vector = double __attribute__((vector_size(8 * PUSHID_VECTOR_DOUBLES)));
constexpr int kTileRows = PUSHID_VECTOR_DOUBLES * PUSHID_TILE_VECTORS;

void AddTile(int depth, const double* left, const double* right, double* c, std::ptrdiff_t stride) {
  Vector sums[PUSHID_TILE_COLUMNS][PUSHID_TILE_VECTORS] = {};
  for (int k = 0; k < depth; ++k) {
    Vector column[PUSHID_TILE_VECTORS];
    __builtin_memcpy(column, left, sizeof(column));
#pragma GCC unroll 16
    for (int j = 0; j < PUSHID_TILE_COLUMNS; ++j) {
#pragma GCC unroll 16
      for (int v = 0; v < PUSHID_TILE_VECTORS; ++v) sums[j][v] += column[v] * right[j];
    }
    left += kTileRows;
    right += PUSHID_TILE_COLUMNS;
  }
  for (int j = 0; j < PUSHID_TILE_COLUMNS; ++j, c += stride) {
    Vector column[PUSHID_TILE_VECTORS];
    __builtin_memcpy(column, c, sizeof(column));
    for (int v = 0; v < PUSHID_TILE_VECTORS; ++v) column[v] += sums[j][v];
    __builtin_memcpy(c, column, sizeof(column));
  }
}

// exp(x) - 1 = 2^n (1 + p) - 1 with p = exp(r) - 1 by its series, x = n ln 2 + r, |r| <= ln 2 / 2:
// p starts with r, so that the result is exact to rounding near zero too.
struct Exponential {
  double power, p;  // 2^n, p
};

inline Exponential Expand(double x) {
  constexpr double kLog2e = 1.4426950408889634074, kRound = 6755399441055744.0;  // 1.5 * 2^52
  constexpr double kLn2High = 6.93145751953125e-1, kLn2Low = 1.42860682030941723212e-6;
  const double shifted = x * kLog2e + kRound;
  const double n = shifted - kRound;
  const double r = (x - n * kLn2High) - n * kLn2Low;
  double series = 1.0 / 6227020800.0;
  series = series * r + 1.0 / 479001600.0;
  series = series * r + 1.0 / 39916800.0;
  series = series * r + 1.0 / 3628800.0;
  series = series * r + 1.0 / 362880.0;
  series = series * r + 1.0 / 40320.0;
  series = series * r + 1.0 / 5040.0;
  series = series * r + 1.0 / 720.0;
  series = series * r + 1.0 / 120.0;
  series = series * r + 1.0 / 24.0;
  series = series * r + 1.0 / 6.0;
  series = series * r + 0.5;
  unsigned long long bits;
  __builtin_memcpy(&bits, &shifted, sizeof(bits));
  bits = (bits + 1023) << 52;  // the shifted number ends in n
  double power;
  __builtin_memcpy(&power, &bits, sizeof(power));
  return {power, r + r * r * series};
}

inline double Clamp(double x, double bound) {
  const double below = x > bound ? bound : x;  // in this order NaN stays NaN
  return below < -bound ? -bound : below;
}

void Tanh(double* values, std::ptrdiff_t count) {
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const Exponential e = Expand(2.0 * Clamp(values[i], 20.0));  // +-1 beyond
    const double expm1 = e.power * e.p + (e.power - 1.0);
    values[i] = expm1 / (expm1 + 2.0);
  }
}

void Logistic(double* values, std::ptrdiff_t count) {
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const Exponential e = Expand(-Clamp(values[i], 700.0));
    values[i] = 1.0 / (1.0 + (e.power + e.power * e.p));
  }
}

constexpr VectorKernels kKernels = {
    PUSHID_VECTOR_NAME, kTileRows, PUSHID_TILE_COLUMNS, AddTile, Tanh, Logistic};

}  // namespace
}  // namespace pushid
