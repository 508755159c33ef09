// residuals: derivatives of M a + C + G; the equations are those of models/ipm.h.
#pragma once

#include "models/ipm.h"

namespace pushid {

// d(M a + C + G)/d(theta, phi, thetad, phid) at fixed acceleration a. Written out: automatic
// derivatives of these four rows took a tenth of a Jacobian.
template <typename T>
Matrix4<T> InverseDynamicsJacobian(const BodyOf<T>& body, const Angles<T>& angles,
                                   const Vector4<T>& qd, const Vector4<T>& a) {
  const auto& [s_th, c_th, s_ph, c_ph] = angles;
  const T ml = body.point_mass() * body.rod_length, l = body.rod_length;
  const T thd = qd[2], phd = qd[3], both = thd * thd + phd * phd;
  const T s2 = 2.0 * s_th * c_th, c2 = c_th * c_th - s_th * s_th;
  const T s_s = s_th * s_ph, s_c = s_th * c_ph, c_s = c_th * s_ph, c_c = c_th * c_ph;
  Matrix4<T> by;  // rows x, y, theta, phi; by theta, phi and their rates
  by << -s_th * a[2] - c_th * thd * thd, T(0.0), -2.0 * s_th * thd, T(0.0),  //
      c_s * a[2] + s_c * a[3] + 2.0 * c_c * thd * phd - s_s * both,
      s_c * a[2] + c_s * a[3] - 2.0 * s_s * thd * phd + c_c * both, 2.0 * (s_c * phd + c_s * thd),
      2.0 * (s_c * thd + c_s * phd),  //
      -s_th * a[0] + c_s * a[1] + l * c2 * phd * phd - kGravity * c_c, s_c * a[1] + kGravity * s_s,
      T(0.0), l * s2 * phd,  //
      s_c * a[1] - l * s2 * a[3] - 2.0 * l * c2 * thd * phd + kGravity * s_s,
      c_s * a[1] - kGravity * c_c, -l * s2 * phd, -l * s2 * thd;
  return ml * by;
}

// d(M a + C + G)/dl at fixed acceleration a.
Vector4<double> InverseDynamicsByRod(const Body& body, const PendulumState<double>& state,
                                     const Vector4<double>& a);

}  // namespace pushid
