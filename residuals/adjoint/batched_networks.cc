// residuals: batched networks, forth and back.
#include "residuals/adjoint/batched_networks.h"

#include <algorithm>

#include "residuals/kernels/vector_kernels.h"

namespace pushid {
namespace {

using Columns = Eigen::MatrixXd;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

template <typename Matrix>
MatrixAt Seen(const Matrix& m) {
  return {m.data(), m.rows(), m.cols(), m.outerStride(), bool{Matrix::IsRowMajor}};
}

// sum += left right; sum: by columns.
template <typename Left, typename Right, typename Sum>
void AddProduct(const Left& left, const Right& right, Sum&& sum) {
  Widest<VectorKernels>().add_product(Seen(left), Seen(right), sum.data(), sum.outerStride());
}

template <typename A>
auto TanhSlopes(const A& a) {
  return 1.0 - a * a;
}
template <typename A>
auto LogisticSlopes(const A& a) {
  return a * (1.0 - a);
}

}  // namespace

BatchedNetwork::BatchedNetwork(const NetworkShape& shape, const BatchColumns& columns,
                               const std::vector<double>& masses)
    : shape_(shape),
      columns_(columns),
      scale_(masses.size()),
      own_(2, masses.size()),
      context_(2, masses.size()) {
  const int people = static_cast<int>(masses.size()), total = columns_.total();
  for (int n = 0; n < people; ++n) {
    scale_[n] = shape.ForceUnit(masses[n]);
    own_.col(n) = NetworkContext(Body{masses[n]});
    context_.col(n) = shape.GateContext(own_.col(n));
  }
  const int rows = shape.gate_rows();
  stacked_.resize(rows, shape.gate_inputs());
  context_sum_.resize(rows, people);
  by_context_sum_.resize(rows, people);
  inputs_.resize(shape.embed_width(), total);
  z_.setZero(shape.gate_inputs(), total);
  activations_.resize(rows, total);
  hidden_.resize(shape.hidden, total);
  outputs_.resize(4, total);
  embedded_.resize(shape.embedding, total);
  hidden_carry_.resize(shape.hidden, people);
  cells_.resize(shape.cells(), total);
  cell_tanh_.resize(shape.cells(), total);
  cell_carry_.resize(shape.cells(), people);
}

void BatchedNetwork::Start(const double* weights) {
  weights_ = weights;
  const NetworkWeights<double> w = Weights();
  stacked_ = w.gates;
  // Apart from the product of every step: a person at rest must feel no force, not even by
  // rounding.
  context_sum_ = w.context * context_;
  by_context_sum_.setZero();
  if (!shape_.ldp()) rest_ = context_sum_.array().tanh();
  hidden_carry_.setZero();
  cell_carry_.setZero();
}

void BatchedNetwork::Forward(int step, const Columns& inputs, Columns* forces) {
  const int n = columns_.active(step), h = shape_.hidden, nf = shape_.num_features();
  const NetworkWeights<double> w = Weights();
  auto seen = At(inputs_, step), z = At(z_, step);
  seen.topRows(kMotionInputs) = inputs;
  seen.bottomRows<2>() = own_.leftCols(n);
  if (!shape_.ldp()) {
    z = inputs;
  } else {
    z.topRows(nf) = (w.embed * seen).cwiseMax(0.0);
    if (step > 0) {
      z.middleRows(nf, h) = At(hidden_, step - 1).leftCols(n);
    } else {
      z.middleRows(nf, h).setZero();
    }
  }
  auto sums = At(activations_, step);
  sums = context_sum_.leftCols(n);
  AddProduct(stacked_, z, sums);
  shape_.ldp() ? ActivateLdp(step) : ActivateMlp(step);
  *forces = w.output.leftCols(h) * At(hidden_, step);
  if (shape_.ldp()) forces->colwise() += w.output.col(h);
  *forces *= scale_.head(n).asDiagonal();
}

void BatchedNetwork::ActivateMlp(int step) {
  auto a = At(activations_, step);
  a = a.array().tanh();
  At(hidden_, step) = a - rest_.leftCols(a.cols());
}

void BatchedNetwork::ActivateLdp(int step) {
  auto gates = At(activations_, step).topRows(3 * shape_.hidden).array();
  gates = gates.logistic();
  auto candidate = Part(activations_, step, 3);
  candidate = candidate.tanh();
  auto cell = At(cells_, step).array();
  cell = Part(activations_, step, 0) * candidate;
  if (step > 0) {
    cell += Part(activations_, step, 1) * At(cells_, step - 1).leftCols(cell.cols()).array();
  }
  auto squashed = At(cell_tanh_, step).array();
  squashed = cell.tanh();
  At(hidden_, step) = Part(activations_, step, 2) * squashed;
}

void BatchedNetwork::Forget(int step, int column) {
  for (Columns* of : {&inputs_, &z_, &activations_, &hidden_, &cells_, &cell_tanh_}) {
    if (of->size() > 0) At(*of, step).col(column).setZero();
  }
}

void BatchedNetwork::DeactivateMlp(int step, const Columns& adjoint) {
  auto a = At(activations_, step).array();
  // tanh' less tanh' at rest, without the difference of what is nearly the same.
  by_context_sum_.leftCols(a.cols()).array() -=
      adjoint.array() * At(hidden_, step).array() * (a + rest_.leftCols(a.cols()).array());
  a = adjoint.array() * TanhSlopes(a);
}

void BatchedNetwork::DeactivateLdp(int step, const Columns& adjoint) {
  const auto hidden = adjoint.array();
  auto input = Part(activations_, step, 0), forget = Part(activations_, step, 1);
  auto output = Part(activations_, step, 2), candidate = Part(activations_, step, 3);
  auto carry = cell_carry_.leftCols(hidden.cols()).array();
  const auto squashed = At(cell_tanh_, step).array();
  const Eigen::ArrayXXd cell = carry + hidden * output * TanhSlopes(squashed);
  output = hidden * squashed * LogisticSlopes(output);
  carry = cell * forget;
  if (step > 0) {
    forget = cell * At(cells_, step - 1).leftCols(cell.cols()).array() * LogisticSlopes(forget);
  } else {
    forget.setZero();
  }
  const Eigen::ArrayXXd by_input = cell * candidate * LogisticSlopes(input);
  candidate = cell * input * TanhSlopes(candidate);
  input = by_input;
  by_context_sum_.leftCols(hidden.cols()) += At(activations_, step);
}

void BatchedNetwork::Backward(int step, const Columns& forces, Columns* inputs) {
  const int n = columns_.active(step), h = shape_.hidden, nf = shape_.num_features();
  auto outputs = At(outputs_, step);
  outputs = forces * scale_.head(n).asDiagonal();
  Columns hidden = Weights().output.leftCols(h).transpose() * outputs;
  if (!shape_.ldp()) {
    DeactivateMlp(step, hidden);
  } else {
    // Columns that end here have none from later.
    hidden += hidden_carry_.leftCols(n);
    DeactivateLdp(step, hidden);
  }
  Columns z = Columns::Zero(shape_.gate_inputs(), n);
  AddProduct(stacked_.transpose(), At(activations_, step), z);
  if (!shape_.ldp()) {
    *inputs = z;
    return;
  }
  hidden_carry_.leftCols(n) = z.middleRows(nf, h);
  auto embedded = At(embedded_, step);
  const auto features = At(z_, step).topRows(nf).array();
  embedded = z.topRows(nf).array() * (features > 0.0).cast<double>();
  *inputs = Weights().embed.leftCols(kMotionInputs).transpose() * embedded;
}

void BatchedNetwork::AddWeightGradient(double* gradient) {
  const int h = shape_.hidden, rows = shape_.gate_rows();
  Eigen::Map<RowMajor> gates(gradient + shape_.gates_at(), rows, shape_.gate_width());
  AddProduct(z_, activations_.transpose(), gates.leftCols(z_.rows()).transpose());
  gates.rightCols<2>() += by_context_sum_ * context_.transpose();
  Eigen::Map<RowMajor>(gradient, shape_.embedding, shape_.embed_width()) +=
      embedded_ * inputs_.transpose();
  Eigen::Map<RowMajor> output(gradient + shape_.output_at(), 4, shape_.output_width());
  output.leftCols(h) += outputs_ * hidden_.transpose();
  if (shape_.ldp()) output.col(h) += outputs_.rowwise().sum();
}

BatchedLayers::BatchedLayers(int inputs, const std::vector<int>& hidden, int outputs,
                             bool rectified)
    : rectified_(rectified), inputs_(inputs, 0) {
  int width = inputs, at = 0;
  const auto add = [&](int rows) {
    layers_.push_back(
        {rows, width, at, Eigen::VectorXd::Zero(rows), Columns(rows, 0), Columns(rows, 0)});
    at += rows * (width + 1);
    width = rows;
  };
  for (int rows : hidden) add(rows);
  add(outputs);
}

void BatchedLayers::Start(const double* weights) {
  weights_ = weights;
  first_ = {0};
  for (Layer& layer : layers_) layer.bias.setZero();
}

void BatchedLayers::Grow() {
  const Eigen::Index total = first_.back(), had = inputs_.cols();
  if (total <= had) return;
  const Eigen::Index now = std::max(total, 2 * had);  // so that few steps copy what there is
  inputs_.conservativeResize(Eigen::NoChange, now);
  for (Layer& layer : layers_) {
    layer.values.conservativeResize(Eigen::NoChange, now);
    layer.back.resize(Eigen::NoChange, now);
  }
}

void BatchedLayers::Forward(const Columns& inputs, Columns* outputs) {
  const int step = static_cast<int>(first_.size()) - 1, n = static_cast<int>(inputs.cols());
  first_.push_back(first_.back() + n);
  outputs->setZero(layers_.back().rows, n);
  if (n == 0) return;
  Grow();
  At(inputs_, step) = inputs;
  for (size_t i = 0; i < layers_.size(); ++i) {
    const ConstRows<double> weights = WeightsOf(layers_[i]);
    auto values = At(layers_[i].values, step);
    values.colwise() = weights.rightCols<1>().col(0);
    AddProduct(weights.leftCols(layers_[i].width), At(Below(i), step), values);
    if (IsOutput(i)) continue;
    if (rectified_) {
      values = values.cwiseMax(0.0);
    } else {
      values = values.array().tanh();
    }
  }
  *outputs = At(layers_.back().values, step);
}

void BatchedLayers::Backward(int step, const Columns& outputs, Columns* inputs) {
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
      back = inputs->array() * TanhSlopes(values.array());
    }
    layer.bias += back.rowwise().sum();
    inputs->setZero(layer.width, n);
    AddProduct(WeightsOf(layer).leftCols(layer.width).transpose(), back, *inputs);
  }
}

void BatchedLayers::AddWeightGradient(double* gradient) {
  const int total = first_.back();
  if (total == 0) return;
  for (size_t i = 0; i < layers_.size(); ++i) {
    const Layer& layer = layers_[i];
    Eigen::Map<RowMajor> by_weight(gradient + layer.at, layer.rows, layer.width + 1);
    AddProduct(Below(i).leftCols(total), layer.back.leftCols(total).transpose(),
               by_weight.leftCols(layer.width).transpose());
    by_weight.col(layer.width) += layer.bias;
  }
}

}  // namespace pushid
