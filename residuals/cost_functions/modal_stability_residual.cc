// residuals: the hinge on the free modes.
#include "residuals/cost_functions/modal_stability_residual.h"

#include <ceres/jet.h>

#include <algorithm>

#include "residuals/cost_functions/rollout_residual.h"

namespace pushid {
namespace {

constexpr double kRate = 3.0;    // 1/s, sqrt(g / l): the modes' natural scale
constexpr double kHinge = 0.01;  // eps

}  // namespace

ModalStabilityResidual::ModalStabilityResidual(const ModelOptions& options, const Body& body,
                                               const ParameterMap& map, double margin,
                                               double weight, bool of_unit)
    : options_(options), body_(body), map_(map), margin_(margin), weight_(weight) {
  mutable_parameter_block_sizes()->push_back(map.num_shared());
  if (of_unit) mutable_parameter_block_sizes()->push_back(map.num_deviations);
  set_num_residuals(kResiduals);
}

template <typename T>
Eigen::Matrix<T, ModalStabilityResidual::kResiduals, 1> ModalStabilityResidual::Hinges(
    const ParameterSet<T>& p) const {
  using std::sqrt;
  constexpr double kScale[] = {kRate, kRate * kRate * kRate, kRate * kRate * kRate};
  const UprightRest<T> rest(options_, body_, p);
  Eigen::Matrix<T, kResiduals, 1> hinges;
  for (int plane = 0; plane < 2; ++plane) {
    const std::array<T, 3> conditions = FreeModes(rest, plane).Shifted(margin_).Conditions();
    for (int i = 0; i < 3; ++i) {
      const T x = -conditions[i] / kScale[i];
      hinges[3 * plane + i] = 0.5 * weight_ * (x + sqrt(x * x + kHinge * kHinge));
    }
  }
  return hinges;
}

Eigen::Matrix<double, ModalStabilityResidual::kResiduals, kNumParameters>
ModalStabilityResidual::ByFitted(const ParameterSet<double>& p) const {
  // A few at a time: duals of jets of all parameters are a hundred times as long.
  constexpr int kAtATime = 8;
  using Jet = ceres::Jet<double, kAtATime>;
  Eigen::Matrix<double, kResiduals, kNumParameters> by_parameter;
  by_parameter.setZero();
  const int fitted = static_cast<int>(map_.fitted.size());
  for (int first = 0; first < fitted; first += kAtATime) {
    const int count = std::min(kAtATime, fitted - first);
    ParameterSet<Jet> jets;
    for (int i = 0; i < kNumParameters; ++i) jets[i] = Jet(p[i]);
    for (int k = 0; k < count; ++k) jets[map_.fitted[first + k].parameter].v[k] = 1.0;
    const Eigen::Matrix<Jet, kResiduals, 1> hinges = Hinges(jets);
    for (int k = 0; k < count; ++k) {
      for (int row = 0; row < kResiduals; ++row) {
        by_parameter(row, map_.fitted[first + k].parameter) = hinges[row].v[k];
      }
    }
  }
  return by_parameter;
}

bool ModalStabilityResidual::Evaluate(double const* const* blocks, double* residuals,
                                      double** jacobians) const {
  const bool of_unit = parameter_block_sizes().size() > 1;
  const ParameterSet<double> p = map_.Apply<double>(blocks[0], of_unit ? blocks[1] : nullptr);
  Eigen::Map<Eigen::Matrix<double, kResiduals, 1>> values(residuals);
  values = Hinges(p);
  if (jacobians == nullptr) return true;
  const Eigen::Matrix<double, kResiduals, kNumParameters> by_parameter = ByFitted(p);
  const int shared = map_.num_shared();
  RowMajorMatrix by_column =
      RowMajorMatrix::Zero(kResiduals, shared + (of_unit ? map_.num_deviations : 0));
  for (const ColumnEntry& entry : map_.Entries(p, of_unit ? shared : -1)) {
    for (int row = 0; row < kResiduals; ++row) {
      by_column(row, entry.column) += entry.derivative * by_parameter(row, entry.parameter);
    }
  }
  ScatterJacobian(by_column, parameter_block_sizes(), 0, kResiduals, jacobians);
  return true;
}

}  // namespace pushid
