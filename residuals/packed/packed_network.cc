// residuals: packed self-force networks, forwards and backwards.
#include "residuals/packed/packed_network.h"

#include <algorithm>

namespace pushid {
namespace {

using Columns = PackedNetwork::Columns;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

int StackedRows(const NetworkShape& shape) {
  return shape.recurrent() ? 4 * shape.hidden : shape.gate_rows();
}

}  // namespace

PackedNetwork::PackedNetwork(const NetworkShape& shape, const VectorKernels& kernels,
                             const PackedColumns& columns, const std::vector<double>& masses)
    : shape_(shape),
      columns_(columns),
      kernels_(kernels),
      rows_(StackedRows(shape)),
      scale_(masses.size()),
      context_(2, masses.size()),
      stacked_(kernels, PackedMatrix::kLeft),
      transposed_(kernels, PackedMatrix::kLeft),
      right_(kernels, PackedMatrix::kRight) {
  const int people = static_cast<int>(masses.size()), total = columns_.total();
  for (int n = 0; n < people; ++n) {
    scale_[n] = kNetworkAcceleration * masses[n];
    context_.col(n) = NetworkState<double>(shape, Body{masses[n]}).context;
  }
  inputs_.resize(kMotionInputs, total);
  z_.setZero(shape.gate_width(), total);
  activations_.resize(rows_, total);
  hidden_.resize(shape.hidden, total);
  outputs_.resize(4, total);
  embedded_.resize(shape.embedding, total);
  hidden_carry_.resize(shape.hidden, people);
  if (shape.kind == NetworkKind::kLstm) {
    cells_.resize(shape.hidden, total);
    cell_tanh_.resize(shape.hidden, total);
    cell_carry_.resize(shape.hidden, people);
  }
}

void PackedNetwork::PackWeights() {
  const int h = shape_.hidden, nf = shape_.num_features(), width = shape_.gate_width();
  const NetworkWeights<double> w = Weights();
  RowMajor stacked = RowMajor::Zero(rows_, width);
  stacked.topLeftCorner(shape_.gate_rows(), w.gates.cols()) = w.gates;
  stacked.topRightCorner(shape_.gate_rows(), 2) = w.context;
  if (shape_.kind == NetworkKind::kLstm) {
    stacked.bottomLeftCorner(h, nf + h) = w.candidates;
  } else if (shape_.kind == NetworkKind::kGru) {
    stacked.block(2 * h, 0, h, nf) = w.candidates.leftCols(nf);
    stacked.block(3 * h, nf, h, h) = w.candidates.rightCols(h);
  }
  stacked_.Pack(stacked.data(), rows_, width, width, 1);
  transposed_.Pack(stacked.data(), width, rows_, 1, width);
}

void PackedNetwork::Start(const double* weights) {
  weights_ = weights;
  PackWeights();
  hidden_carry_.setZero();
  cell_carry_.setZero();
  if (shape_.kind != NetworkKind::kMlp) return;
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
    Columns features = Weights().embed * inputs;
    kernels_.tanh(features.data(), features.size());
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
  *forces = Weights().output * At(hidden_, step);
  *forces *= scale_.head(n).asDiagonal();
}

void PackedNetwork::Activate(int step) {
  const int n = columns_.active(step), h = shape_.hidden, nf = shape_.num_features();
  auto hidden = At(hidden_, step).array();
  for (int column = 0; column < n; ++column) {
    auto sum = At(activations_, step).col(column);
    double* a = sum.data();
    switch (shape_.kind) {
      case NetworkKind::kNone:
        break;
      case NetworkKind::kMlp:
        kernels_.tanh(a, h);
        hidden.col(column) = (sum - rest_.col(column)).array();
        break;
      case NetworkKind::kGru: {
        kernels_.logistic(a, 2 * h);
        sum.segment(2 * h, h) += sum.segment(h, h).cwiseProduct(sum.tail(h));
        kernels_.tanh(a + 2 * h, h);
        const auto candidate = sum.segment(2 * h, h).array();
        const auto before = At(z_, step).col(column).segment(nf, h).array();
        hidden.col(column) = candidate + sum.head(h).array() * (before - candidate);
        break;
      }
      case NetworkKind::kLstm: {
        kernels_.logistic(a, 3 * h);
        kernels_.tanh(a + 3 * h, h);
        auto cell = At(cells_, step).col(column).array();
        cell = sum.head(h).cwiseProduct(sum.tail(h)).array();
        if (step > 0) {
          cell += sum.segment(h, h).array() * At(cells_, step - 1).col(column).array();
        }
        auto squashed = At(cell_tanh_, step).col(column);
        squashed = cell.matrix();
        kernels_.tanh(squashed.data(), h);
        hidden.col(column) = sum.segment(2 * h, h).array() * squashed.array();
        break;
      }
    }
  }
}

void PackedNetwork::Forget(int step, int column) {
  for (Columns* of : {&inputs_, &z_, &activations_, &hidden_, &cells_, &cell_tanh_}) {
    if (of->size() > 0) At(*of, step).col(column).setZero();
  }
}

void PackedNetwork::Deactivate(int step, const Columns& adjoint) {
  const int n = columns_.active(step), h = shape_.hidden, nf = shape_.num_features();
  const auto tanh_slope = [](const auto& a) { return 1.0 - a * a; };
  const auto logistic_slope = [](const auto& a) { return a * (1.0 - a); };
  for (int column = 0; column < n; ++column) {
    const auto hidden = adjoint.col(column).array();
    auto a = At(activations_, step).col(column).array();
    switch (shape_.kind) {
      case NetworkKind::kNone:
        break;
      case NetworkKind::kMlp:
        // tanh' less tanh' at rest, without the difference of what is nearly the same.
        context_sum_.col(column).array() -=
            hidden * At(hidden_, step).col(column).array() * (a + rest_.col(column).array());
        a = hidden * tanh_slope(a);
        break;
      case NetworkKind::kGru: {
        auto keep = a.head(h), reset = a.segment(h, h), candidate = a.segment(2 * h, h);
        auto recurrent = a.tail(h);
        const auto before = At(z_, step).col(column).segment(nf, h).array();
        hidden_carry_.col(column).array() = hidden * keep;
        const Eigen::ArrayXd by_keep = hidden * (before - candidate) * logistic_slope(keep);
        candidate = hidden * (1.0 - keep) * tanh_slope(candidate);
        keep = by_keep;
        const Eigen::ArrayXd by_recurrent = candidate * reset;
        reset = candidate * recurrent * logistic_slope(reset);
        recurrent = by_recurrent;
        break;
      }
      case NetworkKind::kLstm: {
        auto input = a.head(h), forget = a.segment(h, h), output = a.segment(2 * h, h);
        auto candidate = a.tail(h);
        auto carry = cell_carry_.col(column).array();
        const auto squashed = At(cell_tanh_, step).col(column).array();
        const Eigen::ArrayXd cell = carry + hidden * output * tanh_slope(squashed);
        output = hidden * squashed * logistic_slope(output);
        carry = cell * forget;
        if (step > 0) {
          forget = cell * At(cells_, step - 1).col(column).array() * logistic_slope(forget);
        } else {
          forget = 0.0;
        }
        const Eigen::ArrayXd by_input = cell * candidate * logistic_slope(input);
        candidate = cell * input * tanh_slope(candidate);
        input = by_input;
        break;
      }
    }
  }
}

void PackedNetwork::Backward(int step, const Columns& forces, Columns* inputs) {
  const int n = columns_.active(step), h = shape_.hidden, nf = shape_.num_features();
  auto outputs = At(outputs_, step);
  outputs = forces * scale_.head(n).asDiagonal();
  Columns hidden = Weights().output.transpose() * outputs;
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
  embedded = z.topRows(nf).array() * (1.0 - At(z_, step).topRows(nf).array().square());
  *inputs = Weights().embed.transpose() * embedded;
}

void PackedNetwork::AddWeightGradient(double* gradient) {
  const int h = shape_.hidden, nf = shape_.num_features(), width = shape_.gate_width();
  const int total = columns_.total(), gate_rows = shape_.gate_rows();
  PackedMatrix left(kernels_, PackedMatrix::kLeft);
  left.Pack(z_.data(), width, total, 1, width);
  right_.Pack(activations_.data(), rows_, total, 1, rows_);
  RowMajor stacked = RowMajor::Zero(rows_, width);
  AddProduct(left, right_, stacked.data(), width);
  if (shape_.kind == NetworkKind::kMlp) {
    stacked.rightCols<2>() = context_sum_ * context_.transpose();
  }
  Eigen::Map<RowMajor>(gradient + shape_.gates_at(), gate_rows, width) +=
      stacked.topRows(gate_rows);
  Eigen::Map<RowMajor> candidates(gradient + shape_.candidates_at(), shape_.candidate_rows(),
                                  shape_.candidate_width());
  if (shape_.kind == NetworkKind::kLstm) {
    candidates += stacked.bottomLeftCorner(h, nf + h);
  } else if (shape_.kind == NetworkKind::kGru) {
    candidates.leftCols(nf) += stacked.block(2 * h, 0, h, nf);
    candidates.rightCols(h) += stacked.block(3 * h, nf, h, h);
  }
  Eigen::Map<RowMajor>(gradient, shape_.embedding, kMotionInputs) +=
      embedded_ * inputs_.transpose();
  Eigen::Map<RowMajor>(gradient + shape_.output_at(), 4, h) += outputs_ * hidden_.transpose();
}

}  // namespace pushid
