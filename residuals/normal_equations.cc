// residuals: sums of products, and their factor.
#include "residuals/normal_equations.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "residuals/packed/vector_kernels.h"

namespace pushid {
namespace {

constexpr double kNoInformation = 1e-14;  // of a column's own, once the others are known

}  // namespace

NormalEquations::NormalEquations(int columns)
    : columns_(columns), gram_(RowMajorMatrix::Zero(PaddedSize(columns), PaddedSize(columns))) {}

NormalEquations::NormalEquations(int columns, const double* upper, int stride)
    : NormalEquations(columns) {
  for (int row = 0; row <= columns; ++row) {
    for (int column = row; column <= columns; ++column) {
      gram_(row, column) = upper[(row * (columns + 1) + column) * stride];
    }
  }
}

int NormalEquations::PaddedSize(int columns) {
  return (columns + 1 + kGramBlock - 1) / kGramBlock * kGramBlock;
}

void NormalEquations::Add(int count, const double* rows) {
  BestVectorKernels().add_gram(count, gram_.cols(), rows, gram_.cols(), gram_.data(), gram_.cols());
}

RowMajorMatrix NormalEquations::Factor() const {
  const Eigen::Index size = columns_;
  Eigen::VectorXd length = gram_.diagonal().head(size + 1).cwiseSqrt();
  length[size] = 1.0;
  const Eigen::VectorXd scale =
      (length.array() > 0.0).select(length.cwiseInverse(), Eigen::VectorXd::Zero(size + 1));
  RowMajorMatrix left = gram_.topLeftCorner(size + 1, size + 1);  // what the rows so far leave
  left.triangularView<Eigen::StrictlyLower>() = left.transpose();
  left = scale.asDiagonal() * left * scale.asDiagonal();
  RowMajorMatrix factor = RowMajorMatrix::Zero(size + 1, size + 1);
  std::vector<Eigen::Index> open(static_cast<size_t>(size));
  std::iota(open.begin(), open.end(), 0);
  for (Eigen::Index row = 0; row < size; ++row) {
    const auto most = std::max_element(open.begin(), open.end(),
                                       [&left](auto i, auto j) { return left(i, i) < left(j, j); });
    const Eigen::Index pivot = *most;
    if (!(left(pivot, pivot) > kNoInformation)) break;
    open.erase(most);
    const double root = std::sqrt(left(pivot, pivot));
    factor(row, pivot) = root;
    for (Eigen::Index i : open) factor(row, i) = left(pivot, i) / root;
    factor(row, size) = left(pivot, size) / root;
    for (Eigen::Index i : open) left.row(i).noalias() -= factor(row, i) * factor.row(row);
    left(size, size) -= factor(row, size) * factor(row, size);
  }
  factor(size, size) = std::sqrt(std::max(0.0, left(size, size)));
  return factor * length.asDiagonal();
}

}  // namespace pushid
