// models: a fully connected network of single-precision weights, evaluated for many inputs at once:
// y = W_L e(... e(W_1 x + b_1) ...) + b_L, e = ELU (exp(x) - 1 below zero) or max(0, .).
//
// Apart from mlp.h, which is in double precision and has derivatives: a restoration has neither
// need, but poses whole crowds.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace pushid {

struct DenseLayer {
  Eigen::MatrixXf weights;  // outputs x inputs
  Eigen::VectorXf bias;
};

// A column per sample.
Eigen::MatrixXf Applied(const DenseLayer& layer, const Eigen::MatrixXf& values);

struct DenseNetwork {
  std::vector<DenseLayer> layers;  // ELU between them

  int num_inputs() const { return static_cast<int>(layers.front().weights.cols()); }
  int num_outputs() const { return static_cast<int>(layers.back().weights.rows()); }
  // A column per sample.
  Eigen::MatrixXf Evaluate(const Eigen::MatrixXf& inputs) const;
};

// e(x) = x, below zero exp(x) - 1, in place.
void ApplyElu(Eigen::MatrixXf* values);

// Numbers brought to mean 0 and spread 1, and back; one entry per row.
struct Scaling {
  Eigen::VectorXf mean, spread;

  // Held within +-kLargestScaled: a network knows nothing of what lies far outside its data.
  Eigen::MatrixXf Scaled(const Eigen::MatrixXf& values) const;
  Eigen::MatrixXf Unscaled(const Eigen::MatrixXf& values) const;
};
inline constexpr float kLargestScaled = 5.0f;

// Of the columns; a row that hardly varies gets the spread `smallest`.
Scaling ScalingOf(const Eigen::MatrixXf& values, float smallest = 1e-3f);

}  // namespace pushid
