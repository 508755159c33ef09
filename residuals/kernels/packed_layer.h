// residuals: one dense layer [W b] of a network in lockstep, laid out for products with many
// columns.
#pragma once

#include "residuals/kernels/packed_matrix.h"

namespace pushid {

struct PackedLayer {
  int rows, width;  // of W
  int at;           // its first weight
  PackedMatrix weights, transposed;

  PackedLayer(const VectorKernels& kernels, int layer_rows, int layer_width, int first_weight)
      : rows(layer_rows),
        width(layer_width),
        at(first_weight),
        weights(kernels, PackedMatrix::kLeft),
        transposed(kernels, PackedMatrix::kLeft) {}

  int stride() const { return width + 1; }
  int num_weights() const { return rows * stride(); }

  // all: the network's weights, row after row of this layer from `at` on, b last in each.
  void Pack(const double* all) {
    weights.Pack(all + at, rows, width, stride(), 1);
    transposed.Pack(all + at, width, rows, 1, stride());
  }
};

}  // namespace pushid
