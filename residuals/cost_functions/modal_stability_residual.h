// residuals: the free modes of a person at rest shall decay, by a hinge on their polynomial.
//
//   r = weight * hinge(-condition / scale), hinge(x) = (x + sqrt(x^2 + eps^2)) / 2
// for the three Routh-Hurwitz conditions (models/modal_stability.h) of each plane, of the
// polynomial shifted by `margin`: zero (to eps^2) where every mode decays faster than `margin` 1/s.
//   residuals: 6; blocks: the shared parameters and, of_unit, the deviations of a unit.
// Rejected: a hinge on the eigenvalues themselves, whose derivatives are infinite where two of them
// meet, which is where a person stops swinging. Settling residuals (rest_residual.h) alone leave an
// unstable mode that the settling simulations do not excite, such as one to the side.
#pragma once

#include <ceres/cost_function.h>

#include "models/modal_stability.h"
#include "residuals/parameter_map.h"

namespace pushid {

class ModalStabilityResidual : public ceres::CostFunction {
 public:
  static constexpr int kResiduals = 6;

  ModalStabilityResidual(const ModelOptions& options, const Body& body, const ParameterMap& map,
                         double margin, double weight, bool of_unit = false);
  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override;

 private:
  template <typename T>
  Eigen::Matrix<T, kResiduals, 1> Hinges(const ParameterSet<T>& p) const;
  // Derivatives of the hinges by what is fitted; zero by all else.
  Eigen::Matrix<double, kResiduals, kNumParameters> ByFitted(const ParameterSet<double>& p) const;

  ModelOptions options_;
  Body body_;
  ParameterMap map_;
  double margin_, weight_;
};

}  // namespace pushid
