// residuals: Gaussian priors on the fitted scale.
//
//   r = (value - mean) / sigma                    a prior on an entry of a block
// Used for priors on parameters (mean and sigma on the fitted scale, so that a prior on a
// log-positive parameter is log-normal), for partial pooling, a subject's deviation with mean 0,
// and for the weights of a network, which are tied to zero.
#pragma once

#include <ceres/cost_function.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "residuals/parameter_map.h"

namespace pushid {

class PriorResidual : public ceres::CostFunction {
 public:
  // index: the first of `count` entries of a block of `block_size`, a row each.
  PriorResidual(int block_size, int index, double mean, double sigma, int count = 1)
      : index_(index), mean_(mean), sigma_(sigma) {
    mutable_parameter_block_sizes()->push_back(block_size);
    set_num_residuals(count);
  }
  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    const size_t size = static_cast<size_t>(parameter_block_sizes()[0]);
    const bool derivatives = jacobians != nullptr && jacobians[0] != nullptr;
    if (derivatives) std::fill_n(jacobians[0], num_residuals() * size, 0.0);
    for (int i = 0; i < num_residuals(); ++i) {
      residuals[i] = (blocks[0][index_ + i] - mean_) / sigma_;
      if (derivatives) jacobians[0][i * size + index_ + i] = 1.0 / sigma_;
    }
    return true;
  }

 private:
  int index_;
  double mean_, sigma_;
};

// A linear combination of natural parameter values, held near a value.
//
//   r = (sum over k of coefficient_k natural_k - wanted) / sigma
//   block: the shared values on the fitted scale (parameter_map.h).
// Used to profile sums such as mu + Kp_x, which are linear in natural values only.
class CombinationResidual : public ceres::CostFunction {
 public:
  // coefficients: one per fitted parameter; constant: what the fixed ones contribute.
  CombinationResidual(const ParameterMap& map, std::vector<double> coefficients, double constant,
                      double wanted, double sigma)
      : fitted_(map.fitted),
        coefficients_(std::move(coefficients)),
        offset_(constant - wanted),
        sigma_(sigma) {
    mutable_parameter_block_sizes()->push_back(map.num_shared());
    set_num_residuals(1);
  }

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    double sum = offset_;
    for (size_t i = 0; i < fitted_.size(); ++i) {
      const double natural = ToNatural(fitted_[i].transform, blocks[0][i]);
      sum += coefficients_[i] * natural;
      if (jacobians == nullptr || jacobians[0] == nullptr) continue;
      jacobians[0][i] = coefficients_[i] * TransformSlope(fitted_[i].transform, natural) / sigma_;
    }
    residuals[0] = sum / sigma_;
    return true;
  }

 private:
  std::vector<FittedParameter> fitted_;
  std::vector<double> coefficients_;
  double offset_, sigma_;
};

}  // namespace pushid
