// models: forward and, for the derivatives, backward through the layers.
#include "models/network_interaction.h"

namespace pushid {

int Mlp::num_weights() const {
  Eigen::Index count = 0;
  for (const MlpLayer& layer : layers) count += layer.weights.size() + layer.bias.size();
  return static_cast<int>(count);
}

Eigen::VectorXd Mlp::Evaluate(const Eigen::VectorXd& input, Eigen::MatrixXd* by_input) const {
  Eigen::VectorXd value = input;
  std::vector<Eigen::VectorXd> slopes;  // of the hidden layers' activations
  for (size_t i = 0; i < layers.size(); ++i) {
    value = layers[i].weights * value + layers[i].bias;
    if (i + 1 == layers.size()) break;
    if (activation == Activation::kTanh) {
      value = value.array().tanh();
      slopes.push_back(1.0 - value.array().square());
    } else {
      slopes.push_back((value.array() > 0.0).cast<double>());
      value = value.cwiseMax(0.0);
    }
  }
  if (by_input == nullptr) return value;
  *by_input = layers.back().weights;  // few outputs: from the back
  for (size_t i = layers.size() - 1; i-- > 0;) {
    *by_input = (*by_input * slopes[i].asDiagonal() * layers[i].weights).eval();
  }
  return value;
}

}  // namespace pushid
