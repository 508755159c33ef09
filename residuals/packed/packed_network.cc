// residuals: packed self-force networks, forwards.
#include "residuals/packed/packed_network.h"

namespace pushid {
namespace {

using Columns = PackedNetwork::Columns;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

int StackedRows(const NetworkShape& shape) {
  int rows = shape.gate_rows();
  ForCandidates(shape, [&](int, int, int) { rows += shape.hidden; });
  return rows;
}

}  // namespace

PackedNetwork::PackedNetwork(const NetworkShape& shape, const VectorKernels& kernels,
                             const PackedColumns& columns, const std::vector<double>& masses)
    : shape_(shape),
      columns_(columns),
      kernels_(kernels),
      rows_(StackedRows(shape)),
      scale_(masses.size()),
      own_(2, masses.size()),
      context_(2, masses.size()),
      stacked_(kernels, PackedMatrix::kLeft),
      transposed_(kernels, PackedMatrix::kLeft),
      right_(kernels, PackedMatrix::kRight) {
  const int people = static_cast<int>(masses.size()), total = columns_.total();
  for (int n = 0; n < people; ++n) {
    scale_[n] = shape.ForceUnit(masses[n]);
    own_.col(n) = NetworkState<double>(shape, Body{masses[n]}).context;
    context_.col(n) = shape.GateContext(own_.col(n));
  }
  inputs_.resize(kMotionInputs, total);
  z_.setZero(shape.gate_width(), total);
  activations_.resize(rows_, total);
  hidden_.resize(shape.hidden, total);
  outputs_.resize(4, total);
  embedded_.resize(shape.embedding, total);
  hidden_carry_.resize(shape.hidden, people);
  cells_.resize(shape.cells(), total);
  cell_tanh_.resize(shape.cells(), total);
  cell_carry_.resize(shape.cells(), people);
}

void PackedNetwork::PackWeights() {
  const int width = shape_.gate_width();
  const NetworkWeights<double> w = Weights();
  RowMajor stacked = RowMajor::Zero(rows_, width);
  stacked.topLeftCorner(shape_.gate_rows(), w.gates.cols()) = w.gates;
  stacked.topRightCorner(shape_.gate_rows(), 2) = w.context;
  ForCandidates(shape_, [&](int row, int first, int columns) {
    stacked.block(row, first, shape_.hidden, columns) = w.candidates.middleCols(first, columns);
  });
  stacked_.Pack(stacked.data(), rows_, width, width, 1);
  transposed_.Pack(stacked.data(), width, rows_, 1, width);
}

void PackedNetwork::Start(const double* weights) {
  weights_ = weights;
  PackWeights();
  hidden_carry_.setZero();
  cell_carry_.setZero();
  if (shape_.recurrent()) return;
  // By the same product as every step's: a person at rest must feel no force, not even by rounding.
  Columns z = Columns::Zero(shape_.gate_width(), context_.cols());
  z.bottomRows<2>() = context_;
  right_.Pack(z.data(), static_cast<int>(z.cols()), static_cast<int>(z.rows()), z.rows(), 1);
  rest_ = context_sum_ = Columns::Zero(rows_, z.cols());
  AddProduct(stacked_, right_, rest_.data(), rows_);
  kernels_.tanh(rest_.data(), rest_.size());
}

void PackedNetwork::Forward(int step, const Columns& inputs, Columns* forces) {
  const int n = columns_.active(step), h = shape_.hidden, nf = shape_.num_features();
  auto z = At(z_, step);
  At(inputs_, step) = inputs;
  if (shape_.embedding > 0) {
    const NetworkWeights<double> w = Weights();
    Columns features = w.embed.leftCols(kMotionInputs) * inputs;
    if (shape_.biased()) {
      features += w.embed.rightCols(2) * own_.leftCols(n);
      features = features.cwiseMax(0.0);
    } else {
      kernels_.tanh(features.data(), features.size());
    }
    z.topRows(nf) = features;
  } else {
    z.topRows(nf) = inputs;
  }
  if (shape_.recurrent()) {
    if (step > 0) {
      z.middleRows(nf, h) = At(hidden_, step - 1).leftCols(n);
    } else {
      z.middleRows(nf, h).setZero();
    }
  }
  z.bottomRows<2>() = context_.leftCols(n);
  auto sums = At(activations_, step);
  sums.setZero();
  right_.Pack(z.data(), n, shape_.gate_width(), shape_.gate_width(), 1);
  AddProduct(stacked_, right_, sums.data(), rows_);
  Activate(step);
  const NetworkWeights<double> w = Weights();
  *forces = w.output.leftCols(h) * At(hidden_, step);
  if (shape_.biased()) forces->colwise() += w.output.col(h);
  *forces *= scale_.head(n).asDiagonal();
}

void PackedNetwork::ActivateMlp(int step, int column) {
  auto sum = At(activations_, step).col(column);
  kernels_.tanh(sum.data(), shape_.hidden);
  At(hidden_, step).col(column) = sum - rest_.col(column);
}

void PackedNetwork::ActivateGru(int step, int column) {
  const int h = shape_.hidden;
  auto sum = At(activations_, step).col(column);
  kernels_.logistic(sum.data(), 2 * h);
  sum.segment(2 * h, h) += sum.segment(h, h).cwiseProduct(sum.tail(h));
  kernels_.tanh(sum.data() + 2 * h, h);
  const auto candidate = sum.segment(2 * h, h).array();
  const auto before = At(z_, step).col(column).segment(shape_.num_features(), h).array();
  At(hidden_, step).col(column).array() = candidate + sum.head(h).array() * (before - candidate);
}

void PackedNetwork::ActivateLstm(int step, int column) {
  const int h = shape_.hidden;
  auto sum = At(activations_, step).col(column);
  kernels_.logistic(sum.data(), 3 * h);
  kernels_.tanh(sum.data() + 3 * h, h);
  auto cell = At(cells_, step).col(column).array();
  cell = sum.head(h).cwiseProduct(sum.tail(h)).array();
  if (step > 0) {
    cell += sum.segment(h, h).array() * At(cells_, step - 1).col(column).array();
  }
  auto squashed = At(cell_tanh_, step).col(column);
  squashed = cell.matrix();
  kernels_.tanh(squashed.data(), h);
  At(hidden_, step).col(column).array() = sum.segment(2 * h, h).array() * squashed.array();
}

void PackedNetwork::ActivateLdp(int step, int column) { ActivateLstm(step, column); }

void PackedNetwork::Forget(int step, int column) {
  for (Columns* of : {&inputs_, &z_, &activations_, &hidden_, &cells_, &cell_tanh_}) {
    if (of->size() > 0) At(*of, step).col(column).setZero();
  }
}

void PackedNetwork::Activate(int step) {
  for (int column = 0; column < columns_.active(step); ++column) {
    switch (shape_.kind) {
      case NetworkKind::kNone:
        break;
#define PUSHID_NETWORK(id, name, gates, recurrent, cell, biased, Kind) \
  case NetworkKind::id:                                                \
    Activate##Kind(step, column);                                      \
    break;
        PUSHID_SELF_FORCES(PUSHID_NO_SELF_FORCE, PUSHID_NETWORK)
#undef PUSHID_NETWORK
    }
  }
}

}  // namespace pushid
