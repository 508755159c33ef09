// models: what people do to each other in LDP (Yue et al., CVPR 2024, section 3.2): a
// repulsive potential between carts and torques against leaning on each other.
//
// With r = r_n - r_j and v = v_j - v_n of the carts, d = |r|, dt = 1/60 s:
//   U = u exp(-b / sigma),  b = 0.5 sqrt((|r| + |r - dt v|)^2 - (dt |v|)^2),  F on n = -grad_r U
//   torques of constant size k: with s = sign(x_j - x_n),
//     F_theta = -s k  iff  s theta_n >= 0.1 or s theta_j <= -0.1
//   and with s = sign(y_j - y_n), F_phi = +s k  iff  s phi_n <= -0.1 or s phi_j >= 0.1:
//   push away when I lean towards the neighbour or the neighbour leans towards me.
// for d < range (Eq. 10 and 11, and the supplement's table). Equal coordinates count as "behind".
// Not mutual: what n gets from j is not what j gets from n.
#pragma once

#include <cmath>

#include "models/pair.h"

namespace pushid {

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
  int s = j[0] - n[0] > 0.0 ? 1 : -1;
  if (s * n[2] >= kLdpLean || s * j[2] <= -kLdpLean) signs.theta = -s;
  s = j[1] - n[1] > 0.0 ? 1 : -1;
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

struct LdpPublishedTerm {
  template <typename T>
  static void Add(const Pair&, const ParameterSet<T>& p, const PendulumState<T>& n,
                  const PendulumState<T>& j, PairForce<T>* force) {
    if (!InLdpRange(p, n.q, j.q)) return;
    force->acts = true;
    AddOn(p, n, j, &force->on_n);
    AddOn(p, j, n, &force->on_j);
  }

 private:
  template <typename T>
  static void AddOn(const ParameterSet<T>& p, const PendulumState<T>& n, const PendulumState<T>& j,
                    Vector4<T>* on_n) {
    const Eigen::Matrix<T, 2, 1> r = n.q.template head<2>() - j.q.template head<2>();
    const Eigen::Matrix<T, 2, 1> v = j.qd.template head<2>() - n.qd.template head<2>();
    on_n->template head<2>() += LdpRepulsion(p, r, v);
    const LdpTorqueSigns signs = LdpTable(Reals(n.q), Reals(j.q));
    (*on_n)[2] += static_cast<double>(signs.theta) * p[kLeanTheta];
    (*on_n)[3] += static_cast<double>(signs.phi) * p[kLeanPhi];
  }
};

}  // namespace pushid
