// models: a fully connected network of single-precision weights, evaluated for many inputs at once:
// y = W_L e(... e(W_1 x + b_1) ...) + b_L, e = ELU (exp(x) - 1 below zero) or max(0, .).
//
// Apart from mlp.h, which is in double precision and has derivatives: a restoration has neither
// need, but poses whole crowds.
#pragma once

#include <Eigen/Core>
#include <string>
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

// A network's numbers as named matrices, the form in which files hold them.

struct NamedTensor {
  std::string name;
  Eigen::MatrixXf values;
};
using TensorList = std::vector<NamedTensor>;

// Takes tensors out by name and shape and remembers the first that is missing or misshapen.
class TensorReader {
 public:
  explicit TensorReader(const TensorList& tensors) : tensors_(tensors) {}

  // rows or columns of -1: any. Not finite numbers are a problem too.
  Eigen::MatrixXf Take(const std::string& name, int rows, int columns);
  const std::string& problem() const { return problem_; }
  void Fail(const std::string& problem) {
    if (problem_.empty()) problem_ = problem;
  }

 private:
  const TensorList& tensors_;
  std::string problem_;
};

void AddTensors(const std::string& name, const DenseNetwork& network, TensorList* tensors);
void AddTensors(const std::string& name, const DenseLayer& layer, TensorList* tensors);
void AddTensors(const std::string& name, const Scaling& scaling, TensorList* tensors);
// A network of `layers` layers; sizes between them are what the tensors say.
DenseNetwork TakeNetwork(const std::string& name, int layers, int inputs, int outputs,
                         TensorReader* reader);
DenseLayer TakeLayer(const std::string& name, int inputs, int outputs, TensorReader* reader);
Scaling TakeScaling(const std::string& name, int rows, TensorReader* reader);

}  // namespace pushid
