// residuals: a linear combination of natural parameter values, held near a value.
//
//   r = (sum over k of coefficient_k natural_k - wanted) / sigma
//   block: the shared values on the fitted scale (parameter_map.h).
// Used to profile sums such as mu + Kp_x, which are linear in natural values only.
#pragma once

#include <ceres/cost_function.h>

#include <utility>
#include <vector>

#include "residuals/parameter_map.h"

namespace pushid {

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
