// models: forward through dense layers.
#include "models/restoration/dense_network.h"

#include <algorithm>
#include <cmath>

#include "models/restoration/float_product.h"

namespace pushid {

Eigen::MatrixXf Applied(const DenseLayer& layer, const Eigen::MatrixXf& values) {
  Eigen::MatrixXf result = FloatProduct(layer.weights, values);
  result.colwise() += layer.bias;
  return result;
}

void ApplyElu(Eigen::MatrixXf* values) {
  auto v = values->array();
  // Without a branch: exp is vectorized.
  v = v.max(0.0f) + v.min(0.0f).exp() - 1.0f;
}

Eigen::MatrixXf DenseNetwork::Evaluate(const Eigen::MatrixXf& inputs) const {
  Eigen::MatrixXf value = inputs;
  for (size_t i = 0; i < layers.size(); ++i) {
    value = Applied(layers[i], value);
    if (i + 1 < layers.size()) ApplyElu(&value);
  }
  return value;
}

Eigen::MatrixXf Scaling::Scaled(const Eigen::MatrixXf& values) const {
  Eigen::MatrixXf scaled = values.colwise() - mean;
  scaled.array().colwise() /= spread.array();
  return scaled.cwiseMax(-kLargestScaled).cwiseMin(kLargestScaled);
}

Eigen::MatrixXf Scaling::Unscaled(const Eigen::MatrixXf& values) const {
  Eigen::MatrixXf raw = values.array().colwise() * spread.array();
  raw.colwise() += mean;
  return raw;
}

Scaling ScalingOf(const Eigen::MatrixXf& values, float smallest) {
  Scaling scaling;
  const Eigen::MatrixXd wide = values.cast<double>();
  const Eigen::VectorXd mean = wide.rowwise().mean();
  const Eigen::VectorXd variance =
      (wide.colwise() - mean).rowwise().squaredNorm() / std::max<double>(1.0, wide.cols() - 1.0);
  scaling.mean = mean.cast<float>();
  scaling.spread = variance.cwiseSqrt().cast<float>().cwiseMax(smallest);
  return scaling;
}

Eigen::MatrixXf TensorReader::Take(const std::string& name, int rows, int columns) {
  const Eigen::MatrixXf nothing = Eigen::MatrixXf::Zero(std::max(rows, 1), std::max(columns, 1));
  for (const NamedTensor& tensor : tensors_) {
    if (tensor.name != name) continue;
    const Eigen::MatrixXf& values = tensor.values;
    if ((rows >= 0 && values.rows() != rows) || (columns >= 0 && values.cols() != columns)) {
      Fail("the tensor " + name + " is " + std::to_string(values.rows()) + " x " +
           std::to_string(values.cols()) + ", not " + std::to_string(rows) + " x " +
           std::to_string(columns));
      return nothing;
    }
    if (!values.allFinite()) Fail("the tensor " + name + " has entries that are not numbers");
    return values;
  }
  Fail("the tensor " + name + " is missing");
  return nothing;
}

void AddTensors(const std::string& name, const DenseLayer& layer, TensorList* tensors) {
  tensors->push_back({name + ".weights", layer.weights});
  tensors->push_back({name + ".bias", layer.bias});
}

void AddTensors(const std::string& name, const DenseNetwork& network, TensorList* tensors) {
  for (size_t i = 0; i < network.layers.size(); ++i) {
    AddTensors(name + "." + std::to_string(i), network.layers[i], tensors);
  }
}

void AddTensors(const std::string& name, const Scaling& scaling, TensorList* tensors) {
  tensors->push_back({name + ".mean", scaling.mean});
  tensors->push_back({name + ".spread", scaling.spread});
}

void TensorFields::Layer(const std::string& name, int inputs, int outputs, DenseLayer* layer) {
  Matrix(name + ".weights", outputs, inputs, &layer->weights);
  Matrix(name + ".bias", static_cast<int>(layer->weights.rows()), 1, &layer->bias);
}

void TensorFields::Network(const std::string& name, int layers, int inputs, int outputs,
                           DenseNetwork* network) {
  network->layers.resize(layers);
  int width = inputs;
  for (int i = 0; i < layers; ++i) {
    DenseLayer& layer = network->layers[i];
    Layer(name + "." + std::to_string(i), width, i + 1 == layers ? outputs : -1, &layer);
    width = static_cast<int>(layer.weights.rows());
  }
}

void TensorFields::Scales(const std::string& name, int rows, Scaling* scaling) {
  Matrix(name + ".mean", rows, 1, &scaling->mean);
  Positive(name + ".spread", rows, &scaling->spread);
}

}  // namespace pushid
