// residuals: derivatives of a body's masses, by dual numbers over the few parameters that decide
// them.
#include "residuals/sensitivities/body_sensitivities.h"

#include "models/dual.h"

namespace pushid {
namespace {

using BodyDual = Dual<double, kNumBodyParameters>;

ParameterSet<BodyDual> Duals(const ParameterSet<double>& p) {
  ParameterSet<BodyDual> duals{};
  for (int k = 0; k < kNumBodyParameters; ++k) {
    duals[kBodyParameters[k]] = BodyDual::Input(p[kBodyParameters[k]], k);
  }
  return duals;
}

}  // namespace

BodyByParameters BodyJacobian(const ModelOptions& options, const Body& body,
                              const ParameterSet<double>& p, bool holds_fast) {
  BodyByParameters by = BodyByParameters::Zero();
  if (holds_fast) {
    by(1, 0) = 1.0 / p[kComHeight];
  } else if (options.body == BodyModel::kTable) {
    const BodyOf<BodyDual> of = TableBody(body, Duals(p));
    by << of.point_share.v.transpose() / of.point_share.a,
        of.pendulum_ratio.v.transpose() / of.pendulum_ratio.a;
  }
  return by;
}

Eigen::Matrix<double, 2, kNumBodyParameters> HoldOfTableJacobian(const SelfForce& self,
                                                                 const ParameterSet<double>& p) {
  const Eigen::Matrix<BodyDual, 2, 1> hold = HoldOfTable(self, Duals(p));
  Eigen::Matrix<double, 2, kNumBodyParameters> by;
  by << hold[0].v.transpose(), hold[1].v.transpose();
  return by;
}

}  // namespace pushid
