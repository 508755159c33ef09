// models: the convention by which mu is told from Kp.
//
// Friction and the balance gain act on the same velocity, so the data know only their sum,
//   c_x = mu + Kp_x,   c_y = mu_y + Kp_y   (mu_y: the row's along_y, model_rows.h), N s/m.
// A fit holds Kp_x and Kp_y, fits c by way of mu, and says so: mu = c - Kp. Kp free as well leaves
// the two unidentifiable, which the fit then reports.
#pragma once

#include <array>
#include <string_view>

#include "models/options.h"
#include "models/parameters.h"

namespace pushid {

struct CartDamping {
  std::string_view name;
  Parameter friction;  // derived: c - gain
  Parameter gain;      // held

  template <typename T>
  T Of(const ParameterSet<T>& p) const {
    return p[friction] + p[gain];
  }
};

// Which parameter is the friction along y.
constexpr Parameter FrictionAlongY(FrictionKind kind) {
  constexpr Parameter kAlongY[] = {
#define PUSHID_FRICTION(id, name, along_y, ...) along_y,
      PUSHID_FRICTION_LAWS(PUSHID_FRICTION)
#undef PUSHID_FRICTION
  };
  return kAlongY[static_cast<int>(kind)];
}

// Along x, and along y.
constexpr std::array<CartDamping, 2> CartDampings(FrictionKind kind) {
  return {CartDamping{"c_x", kMu, kKpX}, CartDamping{"c_y", FrictionAlongY(kind), kKpY}};
}

// Whether a parameter is one that the convention holds.
constexpr bool HeldByConvention(Parameter id) { return id == kKpX || id == kKpY; }

}  // namespace pushid
