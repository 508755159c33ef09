// residuals: Gaussian priors on the fitted scale, one residual each.
//
//   r = (value - mean) / sigma                    a prior on one entry of a block
// Used for priors on parameters (mean and sigma on the fitted scale, so that a prior on a
// log-positive parameter is log-normal) and for partial pooling: a subject's deviation with mean 0.
#pragma once

#include <ceres/cost_function.h>

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

}  // namespace pushid
