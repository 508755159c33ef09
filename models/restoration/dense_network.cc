// models: forward through dense layers.
#include "models/restoration/dense_network.h"

#include <cmath>

namespace pushid {

Eigen::MatrixXf Applied(const DenseLayer& layer, const Eigen::MatrixXf& values) {
  Eigen::MatrixXf result(layer.weights.rows(), values.cols());
  result.noalias() = layer.weights * values;
  result.colwise() += layer.bias;
  return result;
}

void ApplyElu(Eigen::MatrixXf* values) {
  auto v = values->array();
  // Without a branch: exp is vectorized.
  v = v.max(0.0f) + v.min(0.0f).exp() - 1.0f;
}

Eigen::MatrixXf DenseNetwork::Evaluate(const Eigen::MatrixXf& inputs) const {
  Eigen::MatrixXf value = inputs, next;
  for (size_t i = 0; i < layers.size(); ++i) {
    next.noalias() = layers[i].weights * value;
    next.colwise() += layers[i].bias;
    if (i + 1 < layers.size()) ApplyElu(&next);
    value.swap(next);
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

}  // namespace pushid
