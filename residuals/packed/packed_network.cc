// residuals: packed self-force networks, forth and back.
#include "residuals/packed/packed_network.h"

namespace pushid {
namespace {

using Columns = PackedNetwork::Columns;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

template <typename A>
auto TanhSlopes(const A& a) {
  return 1.0 - a * a;
}
template <typename A>
auto LogisticSlopes(const A& a) {
  return a * (1.0 - a);
}

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

void PackedNetwork::DeactivateMlp(int step, int column, const Columns& adjoint) {
  const auto hidden = adjoint.col(column).array();
  auto a = At(activations_, step).col(column).array();
  // tanh' less tanh' at rest, without the difference of what is nearly the same.
  context_sum_.col(column).array() -=
      hidden * At(hidden_, step).col(column).array() * (a + rest_.col(column).array());
  a = hidden * TanhSlopes(a);
}

void PackedNetwork::DeactivateGru(int step, int column, const Columns& adjoint) {
  const int h = shape_.hidden;
  const auto hidden = adjoint.col(column).array();
  auto a = At(activations_, step).col(column).array();
  auto keep = a.head(h), reset = a.segment(h, h), candidate = a.segment(2 * h, h);
  auto recurrent = a.tail(h);
  const auto before = At(z_, step).col(column).segment(shape_.num_features(), h).array();
  hidden_carry_.col(column).array() = hidden * keep;
  const Eigen::ArrayXd by_keep = hidden * (before - candidate) * LogisticSlopes(keep);
  candidate = hidden * (1.0 - keep) * TanhSlopes(candidate);
  keep = by_keep;
  const Eigen::ArrayXd by_recurrent = candidate * reset;
  reset = candidate * recurrent * LogisticSlopes(reset);
  recurrent = by_recurrent;
}

void PackedNetwork::DeactivateLstm(int step, int column, const Columns& adjoint) {
  const int h = shape_.hidden;
  const auto hidden = adjoint.col(column).array();
  auto a = At(activations_, step).col(column).array();
  auto input = a.head(h), forget = a.segment(h, h), output = a.segment(2 * h, h);
  auto candidate = a.tail(h);
  auto carry = cell_carry_.col(column).array();
  const auto squashed = At(cell_tanh_, step).col(column).array();
  const Eigen::ArrayXd cell = carry + hidden * output * TanhSlopes(squashed);
  output = hidden * squashed * LogisticSlopes(output);
  carry = cell * forget;
  if (step > 0) {
    forget = cell * At(cells_, step - 1).col(column).array() * LogisticSlopes(forget);
  } else {
    forget = 0.0;
  }
  const Eigen::ArrayXd by_input = cell * candidate * LogisticSlopes(input);
  candidate = cell * input * TanhSlopes(candidate);
  input = by_input;
}

void PackedNetwork::DeactivateLdp(int step, int column, const Columns& adjoint) {
  DeactivateLstm(step, column, adjoint);
}

void PackedNetwork::Deactivate(int step, const Columns& hidden) {
  for (int column = 0; column < columns_.active(step); ++column) {
    switch (shape_.kind) {
      case NetworkKind::kNone:
        break;
#define PUSHID_NETWORK(id, name, gates, recurrent, cell, biased, Kind) \
  case NetworkKind::id:                                                \
    Deactivate##Kind(step, column, hidden);                            \
    break;
        PUSHID_SELF_FORCES(PUSHID_NO_SELF_FORCE, PUSHID_NETWORK)
#undef PUSHID_NETWORK
    }
  }
}

void PackedNetwork::Backward(int step, const Columns& forces, Columns* inputs) {
  const int n = columns_.active(step), h = shape_.hidden, nf = shape_.num_features();
  auto outputs = At(outputs_, step);
  outputs = forces * scale_.head(n).asDiagonal();
  Columns hidden = Weights().output.leftCols(h).transpose() * outputs;
  // Columns that end here have none from later.
  if (shape_.recurrent()) hidden += hidden_carry_.leftCols(n);
  hidden_carry_.leftCols(n).setZero();
  Deactivate(step, hidden);

  auto sums = At(activations_, step);
  Columns z = Columns::Zero(shape_.gate_width(), n);
  right_.Pack(sums.data(), n, rows_, rows_, 1);
  AddProduct(transposed_, right_, z.data(), z.rows());
  if (shape_.recurrent()) hidden_carry_.leftCols(n) += z.middleRows(nf, h);
  if (shape_.embedding == 0) {
    *inputs = z.topRows(nf);
    return;
  }
  auto embedded = At(embedded_, step);
  const auto features = At(z_, step).topRows(nf).array();
  if (shape_.biased()) {
    embedded = z.topRows(nf).array() * (features > 0.0).cast<double>();
  } else {
    embedded = z.topRows(nf).array() * TanhSlopes(features);
  }
  *inputs = Weights().embed.leftCols(kMotionInputs).transpose() * embedded;
}

void PackedNetwork::AddWeightGradient(double* gradient) {
  const int h = shape_.hidden, width = shape_.gate_width();
  const int total = columns_.total(), gate_rows = shape_.gate_rows();
  PackedMatrix left(kernels_, PackedMatrix::kLeft);
  left.Pack(z_.data(), width, total, 1, width);
  right_.Pack(activations_.data(), rows_, total, 1, rows_);
  RowMajor stacked = RowMajor::Zero(rows_, width);
  AddProduct(left, right_, stacked.data(), width);
  if (!shape_.recurrent()) {
    stacked.rightCols<2>() = context_sum_ * context_.transpose();
  }
  Eigen::Map<RowMajor>(gradient + shape_.gates_at(), gate_rows, width) +=
      stacked.topRows(gate_rows);
  Eigen::Map<RowMajor> candidates(gradient + shape_.candidates_at(), shape_.candidate_rows(),
                                  shape_.candidate_width());
  ForCandidates(shape_, [&](int row, int first, int columns) {
    candidates.middleCols(first, columns) += stacked.block(row, first, h, columns);
  });
  Eigen::Map<RowMajor> embed(gradient, shape_.embedding, shape_.embed_width());
  embed.leftCols(kMotionInputs) += embedded_ * inputs_.transpose();
  Eigen::Map<RowMajor> output(gradient + shape_.output_at(), 4, shape_.output_width());
  output.leftCols(h) += outputs_ * hidden_.transpose();
  if (!shape_.biased()) return;
  output.col(h) += outputs_.rowwise().sum();
  for (int step = 0; step < columns_.num_steps(); ++step) {
    embed.rightCols(2) += At(embedded_, step) * own_.leftCols(columns_.active(step)).transpose();
  }
}

}  // namespace pushid
