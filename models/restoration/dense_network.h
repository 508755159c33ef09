// models: a fully connected network of single-precision weights, evaluated for many inputs at once:
// y = W_L e(... e(W_1 x + b_1) ...) + b_L, e = ELU (exp(x) - 1 below zero) or max(0, .).
// Apart from learned_terms.h, which is in double precision and has derivatives: a restoration has
// neither need, but poses whole crowds.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace pushid {

// a b, which is what networks do nearly all of the time. Releases are built for any x86-64, where
// Eigen's own products have 128-bit vectors and no fused multiply-add; this loop is compiled for
// the wider ones too, and the processor chooses. Another width rounds otherwise: results repeat bit
// by bit on one machine, and to rounding across. residuals/kernels/vector_kernels.h has the like
// for doubles, and what was rejected.
Eigen::MatrixXf FloatProduct(const Eigen::MatrixXf& a, const Eigen::MatrixXf& b);

struct DenseLayer {
  Eigen::MatrixXf weights;  // outputs x inputs
  Eigen::VectorXf bias;
};

// A column per sample.
Eigen::MatrixXf Applied(const DenseLayer& layer, const Eigen::MatrixXf& values);
// Applied by Eigen's own product, which rounds otherwise.
inline Eigen::MatrixXf AppliedByEigen(const DenseLayer& layer, const Eigen::MatrixXf& values) {
  return (layer.weights * values).colwise() + layer.bias;
}

// Rows of `above`, then those of `below`.
inline Eigen::MatrixXf Stacked(const Eigen::MatrixXf& above, const Eigen::MatrixXf& below) {
  Eigen::MatrixXf both(above.rows() + below.rows(), above.cols());
  both << above, below;
  return both;
}

struct DenseNetwork {
  std::vector<DenseLayer> layers;  // ELU between them
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

// Mean and spread over the columns; a row that hardly varies gets the spread `smallest`.
Scaling ScalingOf(const Eigen::MatrixXf& values, float smallest = 1e-3f);

// The form in which files hold a network's numbers.
struct NamedTensor {
  std::string name;
  Eigen::MatrixXf values;
};
using TensorList = std::vector<NamedTensor>;

// One list of what a network holds serves writing and reading it (AddTensors, TakeTensors):
//
//   void ListTensors(const std::string& prefix, Weights* weights, TensorFields* fields) {
//     fields->Layer(prefix + "query", kInputs, width, &weights->query);
//     ...
// Written: appended to the list. Read: taken by name and shape; the first that is missing or
// misshapen is remembered.
class TensorFields {
 public:
  explicit TensorFields(TensorList* written) : written_(written) {}
  explicit TensorFields(const TensorList& read) : read_(&read) {}

  // A matrix or a column; rows or columns of -1: any. Not finite numbers are a problem too.
  template <typename Values>
  void Matrix(const std::string& name, int rows, int columns, Values* values) {
    if (written_ != nullptr) {
      written_->push_back({name, *values});
    } else {
      *values = Take(name, rows, columns);
    }
  }
  void Layer(const std::string& name, int inputs, int outputs, DenseLayer* layer);
  // `layers` layers; sizes between them are what the tensors say.
  void Network(const std::string& name, int layers, int inputs, int outputs, DenseNetwork* network);
  void Scales(const std::string& name, int rows, Scaling* scaling);
  // A column of positive numbers.
  template <typename Values>
  void Positive(const std::string& name, int rows, Values* values) {
    Matrix(name, rows, 1, values);
    if (read_ != nullptr && !(values->array() > 0.0f).all()) {
      Fail("the tensor " + name + " must be positive");
    }
  }
  const std::string& problem() const { return problem_; }

 private:
  Eigen::MatrixXf Take(const std::string& name, int rows, int columns);
  void Fail(const std::string& problem) {
    if (problem_.empty()) problem_ = problem;
  }

  TensorList* written_ = nullptr;
  const TensorList* read_ = nullptr;
  std::string problem_;
};

template <typename Network>
void AddTensors(const std::string& prefix, const Network& network, TensorList* tensors) {
  Network written = network;
  TensorFields fields(tensors);
  ListTensors(prefix, &written, &fields);
}

// shape: a network of this structure, whose values do not matter.
template <typename Network>
Network TakeTensors(const std::string& prefix, Network shape, TensorFields* read) {
  ListTensors(prefix, &shape, read);
  return shape;
}

}  // namespace pushid
