// residuals: packed laws of the rod, forwards and backwards.
#include "residuals/packed/packed_layers.h"

#include <algorithm>

namespace pushid {

PackedRod::PackedRod(const RodShape& shape, const VectorKernels& kernels,
                     const PackedColumns& columns)
    : columns_(columns),
      kernels_(kernels),
      biased_(shape.biased()),
      top_(shape.num_inputs()),
      right_(kernels, PackedMatrix::kRight) {
  for (int rows : shape.hidden) {
    layers_.push_back({PackedLayer(kernels, rows, top_, output_at_), Eigen::VectorXd(rows),
                       Eigen::VectorXd(rows), Columns(rows, columns_.total()),
                       Columns(rows, columns_.total())});
    output_at_ += layers_.back().num_weights();
    top_ = rows;
  }
  inputs_.resize(shape.num_inputs(), columns_.total());
  outputs_.resize(1, columns_.total());
}

void PackedRod::Start(const double* weights) {
  weights_ = weights;
  for (Layer& layer : layers_) {
    layer.Pack(weights);
    layer.rest = Eigen::Map<const RowMajor, 0, Eigen::OuterStride<>>(
        weights + layer.at + layer.width, layer.rows, 1, Eigen::OuterStride<>(layer.stride()));
    kernels_.tanh(layer.rest.data(), layer.rows);
    if (biased_) layer.rest.setZero();
    layer.bias.setZero();
  }
}

void PackedRod::Forward(int step, const Columns& inputs, Eigen::RowVectorXd* velocities) {
  const int n = columns_.active(step);
  columns_.At(inputs_, step) = inputs;
  for (size_t i = 0; i < layers_.size(); ++i) {
    Layer& layer = layers_[i];
    auto below = columns_.At(Below(i), step), active = columns_.At(layer.active, step);
    for (int row = 0; row < layer.rows; ++row) {
      active.row(row).setConstant(weights_[layer.at + (row + 1) * layer.stride() - 1]);
    }
    right_.Pack(below.data(), n, layer.width, layer.width, 1);
    AddProduct(layer.weights, right_, active.data(), layer.rows);
    if (biased_) {
      active = active.cwiseMax(0.0);
    } else {
      kernels_.tanh(active.data(), active.size());
    }
    columns_.At(layer.hidden, step) = active.colwise() - layer.rest;
  }
  *velocities = Output().transpose() * columns_.At(Below(layers_.size()), step);
  if (biased_) velocities->array() += weights_[output_at_ + top_];
  *velocities *= kRodSpeed;
}

void PackedRod::Backward(int step, const Eigen::RowVectorXd& velocities, Columns* inputs) {
  const int n = columns_.active(step);
  columns_.At(outputs_, step) = kRodSpeed * velocities;
  *inputs = Output() * columns_.At(outputs_, step);
  for (size_t i = layers_.size(); i-- > 0;) {
    Layer& layer = layers_[i];
    auto active = columns_.At(layer.active, step), hidden = columns_.At(layer.hidden, step);
    if (biased_) {
      active = inputs->array() * (active.array() > 0.0).cast<double>();
      layer.bias += active.rowwise().sum();
    } else {
      layer.bias -= (inputs->array() * hidden.array() * (active.colwise() + layer.rest).array())
                        .rowwise()
                        .sum()
                        .matrix();
      active = inputs->array() * (1.0 - active.array().square());
    }
    inputs->setZero(layer.width, n);
    right_.Pack(active.data(), n, layer.rows, layer.rows, 1);
    AddProduct(layer.transposed, right_, inputs->data(), layer.width);
  }
}

void PackedRod::AddWeightGradient(double* gradient) {
  for (size_t i = 0; i < layers_.size(); ++i) {
    const Layer& layer = layers_[i];
    PackedMatrix left(kernels_, PackedMatrix::kLeft);
    left.Pack(Below(i).data(), layer.width, columns_.total(), 1, layer.width);
    right_.Pack(layer.active.data(), layer.rows, columns_.total(), 1, layer.rows);
    RowMajor own = RowMajor::Zero(layer.rows, layer.width);
    AddProduct(left, right_, own.data(), layer.width);
    Eigen::Map<RowMajor> by_weight(gradient + layer.at, layer.rows, layer.stride());
    by_weight.leftCols(layer.width) += own;
    by_weight.col(layer.width) += layer.bias;
  }
  Eigen::Map<Eigen::VectorXd>(gradient + output_at_, top_) +=
      Below(layers_.size()) * outputs_.transpose();
  if (biased_) gradient[output_at_ + top_] += outputs_.sum();
}

namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

}  // namespace

PackedPairs::PackedPairs(const PairShape& shape, const VectorKernels& kernels)
    : kernels_(kernels),
      rectified_(shape.ldp),
      right_(kernels, PackedMatrix::kRight),
      inputs_(PairShape::kInputs, 0) {
  std::vector<int> sizes = shape.hidden;
  sizes.push_back(4);
  int width = PairShape::kInputs, at = 0;
  for (int rows : sizes) {
    layers_.push_back({PackedLayer(kernels, rows, width, at), Columns(rows, 0), Columns(rows, 0)});
    at += layers_.back().num_weights();
    width = rows;
  }
}

void PackedPairs::Start(const double* weights) {
  weights_ = weights;
  first_ = {0};
  for (Layer& layer : layers_) layer.Pack(weights);
}

void PackedPairs::Grow() {
  const Eigen::Index total = first_.back(), had = inputs_.cols();
  if (total <= had) return;
  const Eigen::Index now = std::max(total, 2 * had);  // so that few steps copy what there is
  inputs_.conservativeResize(Eigen::NoChange, now);
  for (Layer& layer : layers_) {
    layer.values.conservativeResize(Eigen::NoChange, now);
    layer.back.resize(Eigen::NoChange, now);
  }
}

void PackedPairs::Forward(const Columns& inputs, Columns* outputs) {
  const int step = static_cast<int>(first_.size()) - 1, n = static_cast<int>(inputs.cols());
  first_.push_back(first_.back() + n);
  outputs->setZero(4, n);
  if (n == 0) return;
  Grow();
  At(inputs_, step) = inputs;
  for (size_t i = 0; i < layers_.size(); ++i) {
    Layer& layer = layers_[i];
    auto below = At(Below(i), step), values = At(layer.values, step);
    values.colwise() = PairLayer(weights_ + layer.at, layer.rows, layer.width).col(layer.width);
    right_.Pack(below.data(), n, layer.width, layer.width, 1);
    AddProduct(layer.weights, right_, values.data(), layer.rows);
    if (IsOutput(i)) continue;
    if (rectified_) {
      values = values.cwiseMax(0.0);
    } else {
      kernels_.tanh(values.data(), values.size());
    }
  }
  *outputs = At(layers_.back().values, step);
}

void PackedPairs::Backward(int step, const Columns& outputs, Columns* inputs) {
  const int n = first_[step + 1] - first_[step];
  *inputs = outputs;
  if (n == 0) return;
  for (size_t i = layers_.size(); i-- > 0;) {
    Layer& layer = layers_[i];
    auto back = At(layer.back, step);
    back = *inputs;
    if (!IsOutput(i)) back.array() *= Slopes(At(layer.values, step));
    inputs->setZero(layer.width, n);
    right_.Pack(back.data(), n, layer.rows, layer.rows, 1);
    AddProduct(layer.transposed, right_, inputs->data(), layer.width);
  }
}

void PackedPairs::AddWeightGradient(double* gradient) {
  const int total = first_.back();
  if (total == 0) return;
  PackedMatrix left(kernels_, PackedMatrix::kLeft);
  for (size_t i = 0; i < layers_.size(); ++i) {
    const Layer& layer = layers_[i];
    left.Pack(Below(i).data(), layer.width, total, 1, layer.width);
    right_.Pack(layer.back.data(), layer.rows, total, 1, layer.rows);
    RowMajor own = RowMajor::Zero(layer.rows, layer.width);
    AddProduct(left, right_, own.data(), layer.width);
    Eigen::Map<RowMajor> by_weight(gradient + layer.at, layer.rows, layer.stride());
    by_weight.leftCols(layer.width) += own;
    by_weight.col(layer.width) += layer.back.leftCols(total).rowwise().sum();
  }
}

}  // namespace pushid
