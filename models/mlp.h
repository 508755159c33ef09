// models: a small fully connected network with fixed weights: its value and its derivatives by the
// inputs, at once and by hand, so that no automatic differentiation runs through the layers.
//
//   y = W_L s(... s(W_1 x + b_1) ...) + b_L, s = tanh or max(0, .)
#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/enum_names.h"

namespace pushid {

enum class Activation { kTanh, kRelu };
constexpr EnumNames<Activation, 2> Names(Activation) {
  return {{{"tanh", Activation::kTanh}, {"relu", Activation::kRelu}}};
}

struct MlpLayer {
  Eigen::MatrixXd weights;  // outputs x inputs
  Eigen::VectorXd bias;
};

struct Mlp {
  Activation activation = Activation::kTanh;
  std::vector<MlpLayer> layers;  // at least one; the last is linear

  int num_inputs() const { return static_cast<int>(layers.front().weights.cols()); }
  int num_outputs() const { return static_cast<int>(layers.back().weights.rows()); }
  int num_weights() const;

  // by_input (outputs x inputs) may be null.
  Eigen::VectorXd Evaluate(const Eigen::VectorXd& input, Eigen::MatrixXd* by_input) const;
};

}  // namespace pushid
