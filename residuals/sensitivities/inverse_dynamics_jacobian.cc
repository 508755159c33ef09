// residuals: derivatives of M a + C + G by the rod.
#include "residuals/sensitivities/inverse_dynamics_jacobian.h"

#include <ceres/jet.h>

namespace pushid {

Vector4<double> InverseDynamicsByRod(const Body& body, const PendulumState<double>& state,
                                     const Vector4<double>& a) {
  using Jet = ceres::Jet<double, 1>;
  const BodyOf<Jet> jets{Jet(body.mass), Jet(body.rod_length, 0), Jet(0.0)};
  const PendulumState<Jet> still{state.q.cast<Jet>(), state.qd.cast<Jet>()};
  const Vector4<Jet> value = InverseDynamics<Jet>(jets, still, a.cast<Jet>());
  return {value[0].v[0], value[1].v[0], value[2].v[0], value[3].v[0]};
}

}  // namespace pushid
