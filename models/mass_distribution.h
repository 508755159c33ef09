// models: bodies that are no point of nine tenths at the hip.
//
// A body with the share s of the mass M above the ankles, whose centre is c l up the rod (l: the
// rod) and whose radius of gyration about that centre is r l, moves exactly like a point
//   m' = M s c^2 / (c^2 + r^2)   on a rod   l' = l (c^2 + r^2) / c:
// m' l' = M s c l is its first moment and m' l'^2 = M s (c^2 + r^2) l^2 its inertia about the
// ankles, and the cart's row holds M in either case.
#pragma once

#include "models/ipm.h"

namespace pushid {

// In shares of the body's mass, and in lengths of the rod.
template <typename T>
struct MassDistributionOf {
  T cart_share = T(kCartShare);
  T com = T(1.0);       // c
  T gyration = T(0.0);  // r
};
using MassDistribution = MassDistributionOf<double>;

// The body with its mass so distributed.
template <typename T, typename L>
BodyOf<T> Distributed(const BodyOf<L>& body, const MassDistributionOf<T>& distribution) {
  const T c2 = distribution.com * distribution.com;
  const T inertia = c2 + distribution.gyration * distribution.gyration;
  return {T(body.mass), T(body.rod_length), T(body.cart_height),
          (1.0 - distribution.cart_share) * c2 / inertia, inertia / distribution.com};
}

}  // namespace pushid
