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

struct DenseNetwork {
  std::vector<DenseLayer> layers;  // ELU between them

  int num_inputs() const { return static_cast<int>(layers.front().weights.cols()); }
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

// One list of what a network holds serves writing and reading it:
//
//   void ListTensors(Weights* weights, TensorFields* fields) {
//     fields->Layer("query", kInputs, width, &weights->query);
//     ...
// Written: appended to the list. Read: taken by name and shape.
class TensorFields {
 public:
  explicit TensorFields(TensorList* written) : written_(written) {}
  explicit TensorFields(TensorReader* read) : read_(read) {}

  template <typename Values>  // a matrix or a column
  void Matrix(const std::string& name, int rows, int columns, Values* values) {
    if (written_ != nullptr) written_->push_back({name, *values});
    if (read_ != nullptr) *values = read_->Take(name, rows, columns);
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
      read_->Fail("the tensor " + name + " must be positive");
    }
  }

 private:
  TensorList* written_ = nullptr;
  TensorReader* read_ = nullptr;
};

void AddTensors(const std::string& name, const DenseNetwork& network, TensorList* tensors);
void AddTensors(const std::string& name, const DenseLayer& layer, TensorList* tensors);
void AddTensors(const std::string& name, const Scaling& scaling, TensorList* tensors);

}  // namespace pushid
