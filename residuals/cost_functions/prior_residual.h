// residuals: Gaussian priors on the fitted scale.
//
//   r = (value - mean) / sigma                    a prior on one entry of a block
// Used for priors on parameters (mean and sigma on the fitted scale, so that a prior on a
// log-positive parameter is log-normal) and for partial pooling: a subject's deviation with mean 0.
#pragma once

#include <ceres/cost_function.h>

#include <algorithm>

namespace pushid {

class PriorResidual : public ceres::CostFunction {
 public:
  // index: entry of a block of `block_size`.
  PriorResidual(int block_size, int index, double mean, double sigma)
      : index_(index), mean_(mean), sigma_(sigma) {
    mutable_parameter_block_sizes()->push_back(block_size);
    set_num_residuals(1);
  }
  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    residuals[0] = (blocks[0][index_] - mean_) / sigma_;
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      for (int i = 0; i < parameter_block_sizes()[0]; ++i) {
        jacobians[0][i] = i == index_ ? 1.0 / sigma_ : 0.0;
      }
    }
    return true;
  }

 private:
  int index_;
  double mean_, sigma_;
};

// All entries of a block over sigma: what ties the weights of a network to zero.
class RidgeResidual : public ceres::CostFunction {
 public:
  RidgeResidual(int block_size, double sigma) : sigma_(sigma) {
    mutable_parameter_block_sizes()->push_back(block_size);
    set_num_residuals(block_size);
  }
  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    const int size = num_residuals();
    for (int i = 0; i < size; ++i) residuals[i] = blocks[0][i] / sigma_;
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      std::fill_n(jacobians[0], static_cast<size_t>(size) * size, 0.0);
      for (int i = 0; i < size; ++i) jacobians[0][static_cast<size_t>(i) * size + i] = 1.0 / sigma_;
    }
    return true;
  }

 private:
  double sigma_;
};

}  // namespace pushid
