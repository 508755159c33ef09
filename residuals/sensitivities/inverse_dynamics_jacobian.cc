// residuals: derivatives of M a + C + G, which rollout_sensitivities.h declares; the equations are
// those of models/ipm.h.
#include <ceres/jet.h>

#include "residuals/sensitivities/rollout_sensitivities.h"

namespace pushid {

// Written out: automatic derivatives of these four rows took a tenth of a Jacobian.
Matrix4<double> InverseDynamicsJacobian(const Body& body, const Angles<double>& angles,
                                        const Vector4<double>& qd, const Vector4<double>& a) {
  const auto& [s_th, c_th, s_ph, c_ph] = angles;
  const double ml = body.point_mass() * body.rod_length, l = body.rod_length;
  const double thd = qd[2], phd = qd[3], both = thd * thd + phd * phd;
  const double s2 = 2.0 * s_th * c_th, c2 = c_th * c_th - s_th * s_th;
  const double s_s = s_th * s_ph, s_c = s_th * c_ph, c_s = c_th * s_ph, c_c = c_th * c_ph;
  Matrix4<double> by;  // rows x, y, theta, phi; by theta, phi and their rates
  by << -s_th * a[2] - c_th * thd * thd, 0.0, -2.0 * s_th * thd, 0.0,  //
      c_s * a[2] + s_c * a[3] + 2.0 * c_c * thd * phd - s_s * both,
      s_c * a[2] + c_s * a[3] - 2.0 * s_s * thd * phd + c_c * both, 2.0 * (s_c * phd + c_s * thd),
      2.0 * (s_c * thd + c_s * phd),  //
      -s_th * a[0] + c_s * a[1] + l * c2 * phd * phd - kGravity * c_c, s_c * a[1] + kGravity * s_s,
      0.0, l * s2 * phd,  //
      s_c * a[1] - l * s2 * a[3] - 2.0 * l * c2 * thd * phd + kGravity * s_s,
      c_s * a[1] - kGravity * c_c, -l * s2 * phd, -l * s2 * thd;
  return ml * by;
}

Vector4<double> InverseDynamicsByRod(const Body& body, const PendulumState<double>& state,
                                     const Vector4<double>& a) {
  using Jet = ceres::Jet<double, 1>;
  const BodyOf<Jet> jets{body.mass, Jet(body.rod_length, 0), Jet(0.0)};
  const PendulumState<Jet> still{state.q.cast<Jet>(), state.qd.cast<Jet>()};
  const Vector4<Jet> value = InverseDynamics<Jet>(jets, still, a.cast<Jet>());
  return {value[0].v[0], value[1].v[0], value[2].v[0], value[3].v[0]};
}

}  // namespace pushid
