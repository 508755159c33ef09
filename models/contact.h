// models: contact between two people, a smooth reciprocal force between points along their rods.
//
// The points stand s rod lengths from the ankles (s = 0: between the carts; 1: the hips). With r =
// (dx, dy) from j to n,
//   d = sqrt(dx^2 + kappa^2 dy^2)     distance in which people are deeper than wide (kappa < 1)
//   d* = softmin(d_contact, d_0)      who stood closer than d_contact stood there free of load
//   load x = d* - d                   compression, m
//   spring  f = A x^2 / (x + w)       N for x > 0, else 0; w = 0.05 m
//   damping f = B x / (x + w) x'
// acts on n along the gradient of d, and its opposite on j. A spring of stiffness A beyond the
// first centimetres, damping B that fades in with the load. The force is continuous, the spring
// with its first derivatives; those of the damping jump at x = 0 from 0 to B x' / w. The sum is not
// held to push: where two people part fast, the damping outweighs the spring and pulls (x' < 0; in
// one published recording up to 45 N, 6.7 N s of pull against 46.6 N s of push). Cutting the pull
// off would make the force itself depend on a switch. Generalized forces by virtual work at the
// points. Rejected: LDP's potential, whose push depends on the neighbour's velocity and is not
// mutual (ldp_interaction.h).
#pragma once

#include <cmath>

#include "models/pair.h"

namespace pushid {

inline constexpr double kContactOnset = 0.05;     // m, w above
inline constexpr double kContactSoftness = 0.02;  // m, of the softmin

template <typename T>
using Vector2 = Eigen::Matrix<T, 2, 1>;

// Position (x, y) of the contact point: at a height of the body, which has the rod of frame 0
// even where the rod moves. Q: of the state, a constant (double) at frame 0.
template <typename T, typename Q>
Vector2<T> ContactPoint(const Body& body, const Vector4<Q>& q, const Angles<Q>& angles,
                        const T& height) {
  const T reach = height * body.rod_length;
  return {q[0] + reach * angles.s_th, q[1] - reach * angles.c_th * angles.s_ph};
}

template <typename T>
Vector2<T> ContactVelocity(const Body& body, const Angles<T>& angles, const Vector4<T>& qd,
                           const T& height) {
  const T reach = height * body.rod_length;
  const auto& [s_th, c_th, s_ph, c_ph] = angles;
  return {qd[0] + reach * c_th * qd[2],
          qd[1] + reach * (s_th * s_ph * qd[2] - c_th * c_ph * qd[3])};
}

// A horizontal force at the contact point as a generalized force (virtual work).
template <typename T>
Vector4<T> ContactGeneralizedForce(const Body& body, const Angles<T>& angles, const T& height,
                                   const T& fx, const T& fy) {
  const T reach = height * body.rod_length;
  const auto& [s_th, c_th, s_ph, c_ph] = angles;
  return {fx, fy, reach * (fx * c_th + fy * s_th * s_ph), -reach * fy * c_th * c_ph};
}

template <typename T>
T ContactDistance(const Eigen::Matrix<T, 2, 1>& r, const T& kappa) {
  using std::sqrt;
  constexpr double kTiny = 1e-12;  // m^2: a derivative also where two points coincide
  return sqrt(r[0] * r[0] + kappa * kappa * r[1] * r[1] + kTiny);
}

// The load x, m, of two points at the distance d that stood at r0 from each other; not positive
// without any.
template <typename T>
T ContactLoad(const ParameterSet<T>& p, const T& d, const Vector2<T>& r0) {
  using std::sqrt;
  const T d0 = ContactDistance(r0, p[kContactKappa]);
  const T gap = p[kContactDistance] - d0;
  const T free =
      0.5 * (p[kContactDistance] + d0 - sqrt(gap * gap + kContactSoftness * kContactSoftness));
  return free - d;
}

// From j's contact point to n's at frame 0.
template <typename T>
Vector2<T> BetweenFirstContactPoints(const Pair& pair, const T& height) {
  return ContactPoint(pair.body_n, pair.first_n.q, pair.first_n.angles, height) -
         ContactPoint(pair.body_j, pair.first_j.q, pair.first_j.angles, height);
}

// The load of two people.
template <typename T>
T LoadBetween(const Pair& pair, const ParameterSet<T>& p, const Vector4<T>& q_n,
              const Vector4<T>& q_j) {
  const T& height = p[kContactHeight];
  const Vector2<T> r = ContactPoint(pair.body_n, q_n, Angles<T>(q_n), height) -
                       ContactPoint(pair.body_j, q_j, Angles<T>(q_j), height);
  const T d = ContactDistance<T>(r, p[kContactKappa]);
  // Free distances are never larger than the contact distance.
  if (RealPart(d) >= RealPart(p[kContactDistance])) return T(0.0);
  return ContactLoad<T>(p, d, BetweenFirstContactPoints(pair, height));
}

// The horizontal force on n's point. r, v: n's point and its velocity, seen from j's; r0: at
// frame 0. Zero without load.
template <bool kSpring, bool kDamping, typename T>
Vector2<T> ContactForce(const ParameterSet<T>& p, const Vector2<T>& r, const Vector2<T>& v,
                        const Vector2<T>& r0) {
  const T& kappa = p[kContactKappa];
  const T d = ContactDistance(r, kappa);
  const T x = ContactLoad(p, d, r0);
  if (!(RealPart(x) > 0.0)) return Vector2<T>::Zero();
  const Vector2<T> along(r[0] / d, kappa * kappa * r[1] / d);
  T f = T(0.0);
  if (kSpring) f += p[kContactStiffness] * x;
  if (kDamping) f -= p[kContactDamping] * (along[0] * v[0] + along[1] * v[1]);
  f *= x / (x + kContactOnset);
  return f * along;
}

template <bool kSpring, bool kDamping>
struct ContactTerm {
  template <typename T>
  static void Add(const Pair& pair, const ParameterSet<T>& p, const PosedPendulum<T>& n,
                  const PosedPendulum<T>& j, PairForce<T>* force) {
    const T& height = p[kContactHeight];
    const Angles<T>&of_n = n.angles, &of_j = j.angles;
    const Vector2<T> r =
        ContactPoint(pair.body_n, n.q, of_n, height) - ContactPoint(pair.body_j, j.q, of_j, height);
    // Free distances are never larger than the contact distance.
    if (RealPart(ContactDistance(r, p[kContactKappa])) >= RealPart(p[kContactDistance])) return;
    const Vector2<T> v = ContactVelocity(pair.body_n, of_n, n.qd, height) -
                         ContactVelocity(pair.body_j, of_j, j.qd, height);
    const Vector2<T> r0 = BetweenFirstContactPoints(pair, height);
    const Vector2<T> f = ContactForce<kSpring, kDamping, T>(p, r, v, r0);
    if (RealPart(f[0]) == 0.0 && RealPart(f[1]) == 0.0) return;
    force->on_n += ContactGeneralizedForce<T>(pair.body_n, of_n, height, f[0], f[1]);
    force->on_j += ContactGeneralizedForce<T>(pair.body_j, of_j, height, T(-f[0]), T(-f[1]));
    force->acts = true;
  }
};

}  // namespace pushid
