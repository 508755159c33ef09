// residuals: packed layers, forwards and backwards.
#include "residuals/packed/packed_layers.h"

#include <algorithm>

namespace pushid {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

}  // namespace

PackedLayers::PackedLayers(const RodShape& shape, const VectorKernels& kernels)
    : PackedLayers(shape.num_inputs(), shape.hidden, 1, shape.biased(), !shape.biased(),
                   shape.biased(), kernels) {}

PackedLayers::PackedLayers(const PairShape& shape, const VectorKernels& kernels)
    : PackedLayers(PairShape::kInputs, shape.hidden, 4, shape.ldp, false, true, kernels) {}

PackedLayers::PackedLayers(int inputs, const std::vector<int>& hidden, int outputs, bool rectified,
                           bool from_rest, bool output_bias, const VectorKernels& kernels)
    : kernels_(kernels),
      rectified_(rectified),
      from_rest_(from_rest),
      right_(kernels, PackedMatrix::kRight),
      inputs_(inputs, 0) {
  int width = inputs, at = 0;
  const auto add = [&](int rows, bool biased) {
    layers_.push_back({PackedLayer(kernels, rows, width, at, biased), Eigen::VectorXd::Zero(rows),
                       Eigen::VectorXd::Zero(rows), Columns(rows, 0), Columns(rows, 0)});
    at += layers_.back().num_weights();
    width = rows;
  };
  for (int rows : hidden) add(rows, true);
  add(outputs, output_bias);
}

Eigen::VectorXd PackedLayers::BiasOf(const Layer& layer) const {
  if (!layer.biased) return Eigen::VectorXd::Zero(layer.rows);
  return ConstRows<double>(weights_ + layer.at + layer.width, layer.rows, 1,
                           Eigen::OuterStride<>(layer.stride()));
}

void PackedLayers::Start(const double* weights) {
  weights_ = weights;
  first_ = {0};
  for (size_t i = 0; i < layers_.size(); ++i) {
    Layer& layer = layers_[i];
    layer.Pack(weights);
    layer.bias.setZero();
    if (!from_rest_ || IsOutput(i)) continue;
    layer.rest = BiasOf(layer);
    kernels_.tanh(layer.rest.data(), layer.rows);
  }
}

void PackedLayers::Grow() {
  const Eigen::Index total = first_.back(), had = inputs_.cols();
  if (total <= had) return;
  const Eigen::Index now = std::max(total, 2 * had);  // so that few steps copy what there is
  inputs_.conservativeResize(Eigen::NoChange, now);
  for (Layer& layer : layers_) {
    layer.values.conservativeResize(Eigen::NoChange, now);
    layer.back.resize(Eigen::NoChange, now);
  }
}

void PackedLayers::Forward(const Columns& inputs, Columns* outputs) {
  const int step = static_cast<int>(first_.size()) - 1, n = static_cast<int>(inputs.cols());
  first_.push_back(first_.back() + n);
  outputs->setZero(layers_.back().rows, n);
  if (n == 0) return;
  Grow();
  At(inputs_, step) = inputs;
  for (size_t i = 0; i < layers_.size(); ++i) {
    Layer& layer = layers_[i];
    auto below = At(Below(i), step), values = At(layer.values, step);
    values.colwise() = BiasOf(layer);
    right_.Pack(below.data(), n, layer.width, layer.width, 1);
    AddProduct(layer.weights, right_, values.data(), layer.rows);
    if (IsOutput(i)) continue;
    if (rectified_) {
      values = values.cwiseMax(0.0);
    } else {
      kernels_.tanh(values.data(), values.size());
      values.colwise() -= layer.rest;
    }
  }
  *outputs = At(layers_.back().values, step);
}

void PackedLayers::Backward(int step, const Columns& outputs, Columns* inputs) {
  const int n = first_[step + 1] - first_[step];
  *inputs = outputs;
  if (n == 0) return;
  for (size_t i = layers_.size(); i-- > 0;) {
    Layer& layer = layers_[i];
    const auto values = At(layer.values, step);
    auto back = At(layer.back, step);
    if (IsOutput(i)) {
      back = *inputs;
    } else if (rectified_) {
      back = inputs->array() * (values.array() > 0.0).cast<double>();
    } else {
      back = inputs->array() * (1.0 - (values.colwise() + layer.rest).array().square());
    }
    if (from_rest_ && !IsOutput(i)) {
      const Columns twice = values.colwise() + 2.0 * layer.rest;
      layer.bias -= inputs->cwiseProduct(values).cwiseProduct(twice).rowwise().sum();
    } else {
      layer.bias += back.rowwise().sum();
    }
    inputs->setZero(layer.width, n);
    right_.Pack(back.data(), n, layer.rows, layer.rows, 1);
    AddProduct(layer.transposed, right_, inputs->data(), layer.width);
  }
}

void PackedLayers::AddWeightGradient(double* gradient) {
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
    if (layer.biased) by_weight.col(layer.width) += layer.bias;
  }
}

}  // namespace pushid
