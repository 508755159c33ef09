// models: laws of friction of the cart; which there are: model_rows.h.
#pragma once

#include <cmath>

#include "models/ipm.h"
#include "models/parameters.h"

namespace pushid {

// Laws of friction (PUSHID_FRICTION_LAWS), without branches, since a scalar may hold several
// people. scale: of forces; p: the parameters from kMu up to kKpX; weight: N.
struct LinearDrag {
  template <typename T, typename L, typename Set>
  static Vector4<T> Force(const L& scale, const Set& p, Parameter along_y, const Vector4<T>& qd,
                          const L& /*weight*/) {
    return {-scale * p[kMu] * qd[0], -scale * p[along_y] * qd[1], T(0.0), T(0.0)};
  }
};

// The same and dry friction: -mu v - mu_c M g v / sqrt(v^2 + v_0^2), which holds no cart still but
// brings it to a creep.
struct CoulombDrag {
  static constexpr double kCreep = 0.01;  // v_0, m/s
  template <typename T, typename L, typename Set>
  static Vector4<T> Force(const L& scale, const Set& p, Parameter along_y, const Vector4<T>& qd,
                          const L& weight) {
    using std::sqrt;
    const T speed = sqrt(qd[0] * qd[0] + qd[1] * qd[1] + T(kCreep * kCreep));
    const T dry = weight * p[kCoulombFriction] / speed;
    return {-(scale * p[kMu] + dry) * qd[0], -(scale * p[along_y] + dry) * qd[1], T(0.0), T(0.0)};
  }
};

}  // namespace pushid
