// models: what two people do to each other: contact, LDP's forces, and the sum of the terms that a
// model asks for (InteractionTerms, options.h), as generalized forces [N, N, N m, N m] on both.
#pragma once

#include <cmath>
#include <type_traits>

#include "models/ipm.h"
#include "models/jet.h"
#include "models/options.h"
#include "models/parameters.h"

namespace pushid {

// A person's pose at frame 0.
struct FirstPose {
  Vector4<double> q = Vector4<double>::Zero();
  Angles<double> angles;

  FirstPose() = default;
  explicit FirstPose(const Vector4<double>& at) : q(at), angles(at) {}
};

// Two people and how they stood at frame 0.
struct Pair {
  Body body_n, body_j;
  FirstPose first_n, first_j;

  Pair Swapped() const { return {body_j, body_n, first_j, first_n}; }
};

template <typename T>
struct PairForce {
  Vector4<T> on_n = Vector4<T>::Zero(), on_j = Vector4<T>::Zero();
  bool acts = false;
};

// Contact between two people, a smooth reciprocal force between points along their rods.
//
// The points stand s rod lengths from the ankles (s = 0: between the carts; 1: the hips). With r =
// (dx, dy) from j to n,
//   d = sqrt(dx^2 + kappa^2 dy^2)     distance in which people are deeper than wide (kappa < 1)
//   d* = softmin(d_contact, d_0)      who stood closer than d_contact stood there free of load
//   load x = d* - d                   compression, m
//   spring  f = A x^2 / (x + w)       N for x > 0, else 0; w = 0.05 m
//   damping f = B x / (x + w) x'
// acts on n along the gradient of d, and its opposite on j. At x = w the spring has half the force
// of a linear one of stiffness A, and the damping fades in with the load. The force is continuous,
// the spring with its first derivatives; those of the damping jump at x = 0 from 0 to B x' / w. The
// sum is not held to push: where two people part fast, the damping outweighs the spring and pulls
// (x' < 0; in one published recording up to 45 N, 6.7 N s of pull against 46.6 N s of push).
// Cutting the pull off would make the force itself depend on a switch. Generalized forces by
// virtual work at the points. Rejected: LDP's potential, whose push depends on the neighbour's
// velocity and is not mutual (below).

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
T ContactDistance(const Vector2<T>& r, const T& kappa) {
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

// The vector from j's contact point to n's at frame 0.
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

// Adds spring and damping, those that are asked for.
template <typename T>
void AddContact(const InteractionTerms& terms, const Pair& pair, const ParameterSet<T>& p,
                const PosedPendulum<T>& n, const PosedPendulum<T>& j, PairForce<T>* force) {
  const T &height = p[kContactHeight], &kappa = p[kContactKappa];
  const Vector2<T> r = ContactPoint(pair.body_n, n.q, n.angles, height) -
                       ContactPoint(pair.body_j, j.q, j.angles, height);
  const T d = ContactDistance(r, kappa);
  // Free distances are never larger than the contact distance.
  if (RealPart(d) >= RealPart(p[kContactDistance])) return;
  const T x = ContactLoad(p, d, BetweenFirstContactPoints(pair, height));
  if (!(RealPart(x) > 0.0)) return;
  const Vector2<T> v = ContactVelocity(pair.body_n, n.angles, n.qd, height) -
                       ContactVelocity(pair.body_j, j.angles, j.qd, height);
  const Vector2<T> along(r[0] / d, kappa * kappa * r[1] / d);
  const T rate = along[0] * v[0] + along[1] * v[1];
  T f = T(0.0);
  if (terms.spring) f += p[kContactStiffness] * x;
  if (terms.damping) f += -(p[kContactDamping] * rate);
  f *= x / (x + kContactOnset);
  const Vector2<T> on_n = f * along;
  if (RealPart(on_n[0]) == 0.0 && RealPart(on_n[1]) == 0.0) return;
  force->on_n += ContactGeneralizedForce<T>(pair.body_n, n.angles, height, on_n[0], on_n[1]);
  force->on_j +=
      ContactGeneralizedForce<T>(pair.body_j, j.angles, height, T(-on_n[0]), T(-on_n[1]));
  force->acts = true;
}

// LDP's forces between people (Yue et al., CVPR 2024, section 3.2): a
// repulsive potential between carts and torques against leaning on each other.
//
// With r = r_n - r_j and v = v_j - v_n of the carts, d = |r|, dt = 1/60 s:
//   U = u exp(-b / sigma),  b = 0.5 sqrt((|r| + |r - dt v|)^2 - (dt |v|)^2),  F on n = -grad_r U
//   torques of constant size k: with s = sign(x_j - x_n),
//     F_theta = -s k  iff  s theta_n >= 0.1 or s theta_j <= -0.1
//   and with s = sign(y_j - y_n), F_phi = +s k  iff  s phi_n <= -0.1 or s phi_j >= 0.1:
//   push away when I lean towards the neighbour or the neighbour leans towards me.
// for d < range (Eq. 10 and 11, and the supplement's table, in which j is behind n where x_n > x_j
// and otherwise in front: so is who stands level, s = +1; the release has such a j behind). Not
// mutual: what n gets from j is not what j gets from n.

inline constexpr double kLdpStep = 1.0 / 60.0;  // s
inline constexpr double kLdpLean = 0.1;         // rad

// b of the potential.
template <typename T>
T LdpEllipse(const Eigen::Matrix<T, 2, 1>& r, const Eigen::Matrix<T, 2, 1>& v) {
  using std::sqrt;
  constexpr double kTiny = 1e-12;  // m^2: a derivative also where two carts coincide
  const Eigen::Matrix<T, 2, 1> step = kLdpStep * v;
  const T near = sqrt(r.squaredNorm() + kTiny), next = sqrt((r - step).squaredNorm() + kTiny);
  return 0.5 * sqrt((near + next) * (near + next) - step.squaredNorm() + kTiny);
}

// LDP's table: the torques on n, in units of their size, by hard switches.
struct LdpTorqueSigns {
  int theta = 0, phi = 0;
};
inline LdpTorqueSigns LdpTable(const Vector4<double>& n, const Vector4<double>& j) {
  LdpTorqueSigns signs;
  int s = n[0] - j[0] > 0.0 ? -1 : 1;
  if (s * n[2] >= kLdpLean || s * j[2] <= -kLdpLean) signs.theta = -s;
  s = n[1] - j[1] > 0.0 ? -1 : 1;
  if (s * n[3] <= -kLdpLean || s * j[3] >= kLdpLean) signs.phi = s;
  return signs;
}

// Whether the carts are closer than the range.
template <typename T>
bool InLdpRange(const ParameterSet<T>& p, const Vector4<T>& q_n, const Vector4<T>& q_j) {
  const double dx = RealPart(q_n[0]) - RealPart(q_j[0]), dy = RealPart(q_n[1]) - RealPart(q_j[1]);
  return std::hypot(dx, dy) < RealPart(p[kNeighbourRange]);
}

// -grad_r U at one of two carts.
template <typename T>
Eigen::Matrix<T, 2, 1> LdpRepulsion(const ParameterSet<T>& p, const Eigen::Matrix<T, 2, 1>& r,
                                    const Eigen::Matrix<T, 2, 1>& v) {
  using std::exp, std::sqrt;
  constexpr double kTiny = 1e-12;  // m^2
  const Eigen::Matrix<T, 2, 1> next = r - kLdpStep * v;
  const T near = sqrt(r.squaredNorm() + kTiny), then = sqrt(next.squaredNorm() + kTiny);
  const T b = LdpEllipse(r, v);
  const Eigen::Matrix<T, 2, 1> slope = (near + then) / (4.0 * b) * (r / near + next / then);
  return (p[kPotentialStrength] / p[kPotentialLength] * exp(-b / p[kPotentialLength])) * slope;
}

template <typename T>
Vector4<double> Reals(const Vector4<T>& v) {
  return {RealPart(v[0]), RealPart(v[1]), RealPart(v[2]), RealPart(v[3])};
}

// LDP's force on n.
template <typename T>
Vector4<T> LdpForce(const ParameterSet<T>& p, const PendulumState<T>& n,
                    const PendulumState<T>& j) {
  const Vector2<T> r = n.q.template head<2>() - j.q.template head<2>();
  const Vector2<T> v = j.qd.template head<2>() - n.qd.template head<2>();
  const Vector2<T> repulsion = LdpRepulsion(p, r, v);
  const LdpTorqueSigns signs = LdpTable(Reals(n.q), Reals(j.q));
  return {repulsion[0], repulsion[1], static_cast<double>(signs.theta) * p[kLeanTheta],
          static_cast<double>(signs.phi) * p[kLeanPhi]};
}

// The sum of the terms a model asks for, between two people: poses as PosedPendulum or, to be posed
// here, as states.
template <typename T>
PairForce<T> InteractionBetween(const InteractionTerms& terms, const Pair& pair,
                                const ParameterSet<T>& p,
                                const std::common_type_t<PosedPendulum<T>>& n,
                                const std::common_type_t<PosedPendulum<T>>& j) {
  PairForce<T> force;
  if (terms.spring || terms.damping) AddContact<T>(terms, pair, p, n, j, &force);
  if (terms.ldp_published && InLdpRange(p, n.q, j.q)) {
    force.acts = true;
    force.on_n += LdpForce<T>(p, n, j);
    force.on_j += LdpForce<T>(p, j, n);
  }
  return force;
}

}  // namespace pushid
