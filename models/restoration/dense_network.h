// models: a fully connected network of single-precision weights, evaluated for many inputs at once:
// y = W_L e(... e(W_1 x + b_1) ...) + b_L, e = ELU (exp(x) - 1 below zero) or max(0, .).
// learned_terms.h has networks of double precision with derivatives; a restoration needs neither,
// but has to be fast for crowds.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace pushid {

// The product a b, which takes nearly all of a network's time. Releases are built for any x86-64,
// where Eigen's products have 128-bit vectors and no fused multiply-add; this loop is also compiled
// for wider vectors, and the processor at hand chooses. Rounding depends on the width: results
// repeat to the bit on one machine, and to rounding across machines.
Eigen::MatrixXf FloatProduct(const Eigen::MatrixXf& a, const Eigen::MatrixXf& b);

struct DenseLayer {
  Eigen::MatrixXf weights;  // outputs x inputs
  Eigen::VectorXf bias;
};

// weights * values + bias; a column per sample.
Eigen::MatrixXf Applied(const DenseLayer& layer, const Eigen::MatrixXf& values);
// weights * values + bias by Eigen's own product, which rounds differently.
inline Eigen::MatrixXf AppliedByEigen(const DenseLayer& layer, const Eigen::MatrixXf& values) {
  return (layer.weights * values).colwise() + layer.bias;
}

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

// ELU in place: x, or exp(x) - 1 below zero.
void ApplyElu(Eigen::MatrixXf* values);

// Scales rows to mean 0 and standard deviation 1, and back.
struct Scaling {
  Eigen::VectorXf mean, spread;

  // Clamped to +-kLargestScaled: a network is not trained far outside its data.
  Eigen::MatrixXf Scaled(const Eigen::MatrixXf& values) const;
  Eigen::MatrixXf Unscaled(const Eigen::MatrixXf& values) const;
};
inline constexpr float kLargestScaled = 5.0f;

// Mean and spread over the columns; a row that hardly varies gets the spread `smallest`.
Scaling ScalingOf(const Eigen::MatrixXf& values, float smallest = 1e-3f);

// A network's numbers as files hold them.
struct NamedTensor {
  std::string name;
  Eigen::MatrixXf values;
};
using TensorList = std::vector<NamedTensor>;

// One list of a network's tensors serves writing and reading (AddTensors, TakeTensors):
//
//   void ListTensors(const std::string& prefix, Weights* weights, TensorFields* fields) {
//     fields->Layer(prefix + "query", kInputs, width, &weights->query);
//     ...
//   }
// Written tensors are appended to the list. Read tensors are found by name and must have the given
// shape; the first problem is kept.
class TensorFields {
 public:
  explicit TensorFields(TensorList* written) : written_(written) {}
  explicit TensorFields(const TensorList& read) : read_(&read) {}

  // A matrix or a column of finite numbers; rows or columns of -1: any number.
  template <typename Values>
  void Matrix(const std::string& name, int rows, int columns, Values* values) {
    if (written_ != nullptr) {
      written_->push_back({name, *values});
    } else {
      *values = Take(name, rows, columns);
    }
  }
  void Layer(const std::string& name, int inputs, int outputs, DenseLayer* layer);
  // The sizes between the layers are those of the tensors.
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
