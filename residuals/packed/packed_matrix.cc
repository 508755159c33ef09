// residuals: packing, and the loops about the tiles.
#include "residuals/packed/packed_matrix.h"

namespace pushid {
namespace {

// A panel of a block stays in the second-level cache.
constexpr int kBlockDepth = 320;

}  // namespace

void PackedMatrix::Pack(const double* from, int rows, int depth, std::ptrdiff_t row_stride,
                        std::ptrdiff_t depth_stride) {
  rows_ = rows;
  depth_ = depth;
  const int blocks = std::max(1, (depth + kBlockDepth - 1) / kBlockDepth);
  block_depth_ = std::max(1, (depth + blocks - 1) / blocks);
  values_.resize(static_cast<size_t>(padded_rows()) * depth);
  double* to = values_.data();
  for (int begin = 0; begin < depth; begin += block_depth_) {
    const int end = std::min(begin + block_depth_, depth);
    for (int row = 0; row < rows; row += width_) {
      const int used = std::min(width_, rows - row);
      for (int k = begin; k < end; ++k, to += width_) {
        const double* source = from + row * row_stride + k * depth_stride;
        for (int i = 0; i < used; ++i) to[i] = source[i * row_stride];
        for (int i = used; i < width_; ++i) to[i] = 0.0;
      }
    }
  }
}

void AddProduct(const PackedMatrix& left, const PackedMatrix& right, double* c,
                std::ptrdiff_t stride) {
  const VectorKernels& kernels = left.kernels();
  const int m = kernels.tile_rows, n = kernels.tile_columns;
  std::vector<double> edge(static_cast<size_t>(m) * n);
  for (int begin = 0, block = 0; begin < left.depth(); begin += left.block_depth(), ++block) {
    const int deep = std::min(left.block_depth(), left.depth() - begin);
    for (int row = 0; row < left.rows(); row += m) {
      const double* panel = left.Panel(block, row / m);
      for (int column = 0; column < right.rows(); column += n) {
        const double* other = right.Panel(block, column / n);
        double* tile = c + row + column * stride;
        const int rows = std::min(m, left.rows() - row);
        const int columns = std::min(n, right.rows() - column);
        if (rows == m && columns == n) {
          kernels.add_tile(deep, panel, other, tile, stride);
          continue;
        }
        std::fill(edge.begin(), edge.end(), 0.0);
        kernels.add_tile(deep, panel, other, edge.data(), m);
        for (int j = 0; j < columns; ++j) {
          for (int i = 0; i < rows; ++i) tile[i + j * stride] += edge[i + j * m];
        }
      }
    }
  }
}

}  // namespace pushid
