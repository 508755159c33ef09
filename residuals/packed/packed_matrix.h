// residuals: products of matrices whose sides are laid out for the vector kernels.
//
//   PackedMatrix left(kernels, PackedMatrix::kLeft), right(kernels, PackedMatrix::kRight);
//   left.Pack(a, m, depth, 1, m);              // a: m x depth, by columns
//   right.Pack(b, n, depth, depth, 1);         // b: depth x n, by columns; its "rows" are n
//   AddProduct(left, right, c, m);             // c += a b, by columns
// What serves many products (a network's weights over a rollout) is packed once.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <vector>

#include "residuals/packed/vector_kernels.h"

namespace pushid {

class PackedMatrix {
 public:
  enum Side { kLeft, kRight };
  PackedMatrix(const VectorKernels& kernels, Side side)
      : kernels_(&kernels), width_(side == kLeft ? kernels.tile_rows : kernels.tile_columns) {}

  // Row i at depth k is from[i * row_stride + k * depth_stride].
  void Pack(const double* from, int rows, int depth, std::ptrdiff_t row_stride,
            std::ptrdiff_t depth_stride);

  int rows() const { return rows_; }
  int depth() const { return depth_; }
  int block_depth() const { return block_depth_; }
  int width() const { return width_; }
  const VectorKernels& kernels() const { return *kernels_; }
  // The panel of rows [panel * width, ...), of the depths [block * block_depth, ...).
  const double* Panel(int block, int panel) const {
    const int begin = block * block_depth_;
    const int deep = std::min(block_depth_, depth_ - begin);
    return values_.data() + static_cast<std::ptrdiff_t>(begin) * padded_rows() +
           static_cast<std::ptrdiff_t>(panel) * width_ * deep;
  }

 private:
  int padded_rows() const { return (rows_ + width_ - 1) / width_ * width_; }

  const VectorKernels* kernels_;
  int width_, rows_ = 0, depth_ = 0, block_depth_ = 0;
  std::vector<double> values_;  // by block, then panel, then depth; rows beyond the last are zero
};

// c (by columns, `stride` apart) += left right. Always in the same order of summation.
void AddProduct(const PackedMatrix& left, const PackedMatrix& right, double* c,
                std::ptrdiff_t stride);

// One dense layer [W b] of a packed network, laid out for products with many columns.
struct PackedLayer {
  int rows, width;  // of W
  int at;           // its first weight
  bool biased;      // whether it has a b
  PackedMatrix weights, transposed;

  PackedLayer(const VectorKernels& kernels, int layer_rows, int layer_width, int first_weight,
              bool has_bias)
      : rows(layer_rows),
        width(layer_width),
        at(first_weight),
        biased(has_bias),
        weights(kernels, PackedMatrix::kLeft),
        transposed(kernels, PackedMatrix::kLeft) {}

  int stride() const { return width + (biased ? 1 : 0); }
  int num_weights() const { return rows * stride(); }

  // all: the network's weights, row after row of this layer from `at` on, b last in each.
  void Pack(const double* all) {
    weights.Pack(all + at, rows, width, stride(), 1);
    transposed.Pack(all + at, width, rows, 1, stride());
  }
};

}  // namespace pushid
