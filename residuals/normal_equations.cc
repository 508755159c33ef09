// residuals: sums of products, and their factor.
#include "residuals/normal_equations.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "residuals/kernels/vector_kernels.h"

namespace pushid {
namespace {

constexpr double kNoInformation = 1e-14;  // of a column's own, once the others are known

}  // namespace

NormalEquations::NormalEquations(int columns)
    : columns_(columns),
      gradient_(Eigen::VectorXd::Zero(PaddedSize(columns))),
      information_(RowMajorMatrix::Zero(PaddedSize(columns), PaddedSize(columns))) {}

NormalEquations::NormalEquations(int columns, const double* upper, int stride)
    : NormalEquations(columns) {
  const auto at = [=](int row, int column) {
    return upper[(row * (columns + 1) + column) * stride];
  };
  for (int row = 0; row < columns; ++row) {
    for (int column = row; column < columns; ++column) information_(row, column) = at(row, column);
    gradient_[row] = at(row, columns);
  }
  squares_ = at(columns, columns);
}

int NormalEquations::PaddedSize(int columns) {
  return (columns + kGramBlock - 1) / kGramBlock * kGramBlock;
}

void NormalEquations::Add(int count, const double* rows, const double* residuals) {
  const VectorKernels& kernels = Widest<VectorKernels>();
  const Eigen::Index padded = information_.cols();
  kernels.add_gram(count, padded, rows, padded, information_.data(), padded);
  kernels.add_rows(count, padded, residuals, rows, padded, gradient_.data());
  squares_ += Eigen::Map<const Eigen::VectorXd>(residuals, count).squaredNorm();
}

void NormalEquations::Add(const NormalEquations& other) {
  information_ += other.information_;
  gradient_ += other.gradient_;
  squares_ += other.squares_;
}

RowMajorMatrix NormalEquations::Factor() const {
  const Eigen::Index size = columns_;
  Eigen::VectorXd length(size + 1);
  length << information_.diagonal().head(size).cwiseSqrt(), 1.0;
  const Eigen::VectorXd scale =
      (length.array() > 0.0).select(length.cwiseInverse(), Eigen::VectorXd::Zero(size + 1));
  RowMajorMatrix left(size + 1, size + 1);  // what the rows so far leave
  left.topLeftCorner(size, size) = information_.topLeftCorner(size, size);
  left.col(size) << gradient_.head(size), squares_;
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
