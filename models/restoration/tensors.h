// models: a network's numbers as named matrices, the form in which files hold them.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "models/restoration/dense_network.h"

namespace pushid {

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
