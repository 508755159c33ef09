// residuals: the hinge on the free modes.
#include "residuals/mode_residual.h"

#include <ceres/jet.h>

namespace pushid {
namespace {

constexpr double kRate = 3.0;    // 1/s, sqrt(g / l): the modes' natural scale
constexpr double kHinge = 0.01;  // eps

}  // namespace

ModeResidual::ModeResidual(const ModelOptions& options, const Body& body, const ParameterMap& map,
                           double margin, double weight)
    : options_(options), body_(body), map_(map), margin_(margin), weight_(weight) {
  mutable_parameter_block_sizes()->push_back(map.num_shared());
  set_num_residuals(kResiduals);
}

template <typename T>
Eigen::Matrix<T, ModeResidual::kResiduals, 1> ModeResidual::Hinges(const ParameterSet<T>& p) const {
  using std::sqrt;
  constexpr double kScale[] = {kRate, kRate * kRate * kRate, kRate * kRate * kRate};
  Eigen::Matrix<T, kResiduals, 1> hinges;
  for (int plane = 0; plane < 2; ++plane) {
    const std::array<T, 3> conditions =
        FreeModes(options_, body_, p, plane).Shifted(margin_).Conditions();
    for (int i = 0; i < 3; ++i) {
      const T x = -conditions[i] / kScale[i];
      hinges[3 * plane + i] = 0.5 * weight_ * (x + sqrt(x * x + kHinge * kHinge));
    }
  }
  return hinges;
}

bool ModeResidual::Evaluate(double const* const* blocks, double* residuals,
                            double** jacobians) const {
  const ParameterSet<double> p = map_.Apply<double>(blocks[0], nullptr);
  Eigen::Map<Eigen::Matrix<double, kResiduals, 1>> values(residuals);
  values = Hinges(p);
  if (jacobians == nullptr || jacobians[0] == nullptr) return true;
  using Jet = ceres::Jet<double, kNumParameters>;
  ParameterSet<Jet> jets;
  for (int i = 0; i < kNumParameters; ++i) jets[i] = Jet(p[i], i);
  const Eigen::Matrix<Jet, kResiduals, 1> hinges = Hinges(jets);
  Eigen::Map<Eigen::Matrix<double, kResiduals, Eigen::Dynamic, Eigen::RowMajor>> jacobian(
      jacobians[0], kResiduals, map_.num_shared());
  jacobian.setZero();
  for (const ColumnEntry& entry : map_.Entries(p, -1)) {
    for (int row = 0; row < kResiduals; ++row) {
      jacobian(row, entry.column) += entry.derivative * hinges[row].v[entry.parameter];
    }
  }
  return true;
}

}  // namespace pushid
