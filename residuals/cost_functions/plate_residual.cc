// residuals: derivatives of the rows of platforms.
#include "residuals/cost_functions/plate_residual.h"

#include <ceres/jet.h>

namespace pushid {

PlateVector<double> PlateResidualWithJacobian(const PlatePlace& place,
                                              const ParameterSet<double>& p,
                                              const PendulumState<double>& state,
                                              const Vector4<double>& next_qd,
                                              const PlateFrame& measured,
                                              const ResidualSigmas& sigmas,
                                              PlateJacobian* jacobian) {
  using Jet = ceres::Jet<double, kPlateColumns>;
  const double weight = place.Known() ? measured.weight : 0.0;
  if (weight <= 0.0) {
    jacobian->setZero();
    return PlateVector<double>::Zero();
  }
  PendulumState<Jet> jets;
  Vector4<Jet> next;
  for (int i = 0; i < 4; ++i) {
    jets.q[i] = Jet(state.q[i], i);
    jets.qd[i] = Jet(state.qd[i], 4 + i);
    next[i] = Jet(next_qd[i], 8 + i);
  }
  ParameterSet<Jet> parameters;  // none but these are asked for
  for (int i = 0; i < kNumPlateParameters; ++i) {
    const Parameter id = kPlateParameters[i];
    parameters[id] = Jet(p[id], 12 + i);
  }
  const PlateVector<Jet> values =
      RawPlateResidual<Jet>(place, parameters, jets, next, measured, sigmas);
  PlateVector<double> r;
  for (int i = 0; i < kPlateResiduals; ++i) {
    r[i] = values[i].a;
    jacobian->row(i) = values[i].v.transpose();
  }
  return RobustlyWeighted(r, weight, sigmas.robust, jacobian);
}

}  // namespace pushid
