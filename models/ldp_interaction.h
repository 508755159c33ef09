// models: what people do to each other in LDP (Yue et al., CVPR 2024, section 3.2 and its released
// code): a repulsive potential between carts and torques against leaning on each other.
//
// With r = r_n - r_j and v = v_j - v_n of the carts, d = |r|, dt = 1/60 s:
//   U = u exp(-b / sigma),  b = 0.5 sqrt((|r| + |r - dt v|)^2 - (dt |v|)^2),  F on n = -grad_r U
//   torques of constant size k: with s = sign(x_j - x_n),
//     F_theta = -s k  iff  s theta_n >= 0.1 or s theta_j <= -0.1
//   and with s = sign(y_j - y_n), F_phi = +s k  iff  s phi_n <= -0.1 or s phi_j >= 0.1:
//   push away when I lean towards the neighbour or the neighbour leans towards me.
// for d < range. Not mutual: what n gets from j is not what j gets from n.
//
// LdpPublishedTerm is this, as the paper has it (Eq. 10 and 11, and the supplement's table).
// LdpDiscreteTerm is what was released: the same with forward differences of 1 mm, 100 N m for both
// torques (lean_phi=100), only of neighbours faster than 0.1 m/s, and all of it times
//   clamp(|v|, 0.8, 10) min(1, 0.5 + (range - d) 0.5 / 0.4).
// Equal coordinates count as "behind". PotentialTerm and LeanTerm are smooth twins of what was
// released, for fitting: tanh switches, soft clamp and minimum, the exact gradient; the clamp at
// 10 m/s is left out: no motion gets there.
#pragma once

#include <algorithm>
#include <cmath>

#include "models/pair.h"

namespace pushid {

inline constexpr double kLdpStep = 1.0 / 60.0;   // s
inline constexpr double kLdpLean = 0.1;          // rad
inline constexpr double kLdpMovingSpeed = 0.1;   // m/s
inline constexpr double kLdpSlowest = 0.8;       // m/s, lower end of the speed gain
inline constexpr double kLdpFastest = 10.0;      // m/s, its upper end
inline constexpr double kLdpDifference = 1e-3;   // m, of the forward differences
inline constexpr double kLdpFullGainSpan = 0.4;  // m inside the range the distance gain reaches 1

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

// A term that says, by AddOn, what each of two people gets from the other.
template <typename Term>
struct ToEachOther {
  template <typename T>
  static void Add(const Pair&, const ParameterSet<T>& p, const PendulumState<T>& n,
                  const PendulumState<T>& j, PairForce<T>* force) {
    Term::AddOn(p, n, j, &force->on_n, &force->acts);
    Term::AddOn(p, j, n, &force->on_j, &force->acts);
  }
};

struct LdpPublishedTerm : ToEachOther<LdpPublishedTerm> {
  template <typename T>
  static void AddOn(const ParameterSet<T>& p, const PendulumState<T>& n, const PendulumState<T>& j,
                    Vector4<T>* on_n, bool* acts) {
    if (!InLdpRange(p, n.q, j.q)) return;
    *acts = true;
    const Eigen::Matrix<T, 2, 1> r = n.q.template head<2>() - j.q.template head<2>();
    const Eigen::Matrix<T, 2, 1> v = j.qd.template head<2>() - n.qd.template head<2>();
    on_n->template head<2>() += LdpRepulsion(p, r, v);
    const LdpTorqueSigns signs = LdpTable(Reals(n.q), Reals(j.q));
    (*on_n)[2] += static_cast<double>(signs.theta) * p[kLeanTheta];
    (*on_n)[3] += static_cast<double>(signs.phi) * p[kLeanPhi];
  }
};

struct LdpDiscreteTerm : ToEachOther<LdpDiscreteTerm> {
  template <typename T>
  static void AddOn(const ParameterSet<T>& p, const PendulumState<T>& n, const PendulumState<T>& j,
                    Vector4<T>* on_n, bool* acts) {
    using std::exp, std::min, std::sqrt;
    const Eigen::Matrix<T, 2, 1> r = n.q.template head<2>() - j.q.template head<2>();
    const Eigen::Matrix<T, 2, 1> v = j.qd.template head<2>() - n.qd.template head<2>();
    const T d = r.norm();
    const bool moving =
        RealPart(j.qd.template head<2>().squaredNorm()) > kLdpMovingSpeed * kLdpMovingSpeed;
    if (!(RealPart(d) < RealPart(p[kNeighbourRange])) || !moving) return;
    const auto potential = [&](const Eigen::Matrix<T, 2, 1>& at) -> T {
      return p[kPotentialStrength] * exp(-LdpEllipse(at, v) / p[kPotentialLength]);
    };
    const T here = potential(r);
    Vector4<T> sum;
    for (int axis = 0; axis < 2; ++axis) {
      Eigen::Matrix<T, 2, 1> moved = r;
      moved[axis] += kLdpDifference;
      sum[axis] = -(potential(moved) - here) / kLdpDifference;
    }
    const LdpTorqueSigns signs = LdpTable(Reals(n.q), Reals(j.q));
    sum[2] = static_cast<double>(signs.theta) * p[kLeanTheta];
    sum[3] = static_cast<double>(signs.phi) * p[kLeanPhi];
    T speed = v.squaredNorm();
    speed = RealPart(speed) > kLdpSlowest * kLdpSlowest ? T(sqrt(speed)) : T(kLdpSlowest);
    if (RealPart(speed) > kLdpFastest) speed = T(kLdpFastest);
    T gain = 0.5 + (p[kNeighbourRange] - d) * (0.5 / kLdpFullGainSpan);
    if (RealPart(gain) > 1.0) gain = T(1.0);
    *on_n += (speed * gain) * sum;
    *acts = true;
  }
};

// Widths of the smooth twins' switches.
inline constexpr double kLdpSoftDistance = 0.05;  // m
inline constexpr double kLdpSoftSpeed = 0.05;     // m/s, of the neighbour's motion
inline constexpr double kLdpSoftClamp = 0.2;      // m/s, of the speed gain's lower end
inline constexpr double kLdpSoftLean = 0.03;      // rad
inline constexpr double kLdpSoftSide = 0.05;      // m, where in front turns into behind
inline constexpr double kLdpSoftGain = 0.05;      // of the distance gain's upper end

// 0 far below zero, 1 far above.
template <typename T>
T SoftStep(const T& x, double width) {
  using std::tanh;
  return 0.5 * (1.0 + tanh(x / width));
}

// Beyond this cart distance the smooth twins are cut off: the switch is below 1e-5 there.
template <typename T>
double SmoothLdpReach(const ParameterSet<T>& p) {
  return RealPart(p[kNeighbourRange]) + 6.0 * kLdpSoftDistance;
}

// The factor on everything n gets from j; zero beyond the reach.
template <typename T>
T SmoothLdpGain(const ParameterSet<T>& p, const PendulumState<T>& n, const PendulumState<T>& j) {
  using std::sqrt;
  constexpr double kTiny = 1e-8;  // m^2 and m^2/s^2: derivatives at zero
  const Eigen::Matrix<T, 2, 1> r = n.q.template head<2>() - j.q.template head<2>();
  const Eigen::Matrix<T, 2, 1> v = j.qd.template head<2>() - n.qd.template head<2>();
  const T d = sqrt(r.squaredNorm() + kTiny);
  if (RealPart(d) > SmoothLdpReach(p)) return T(0.0);
  const T speed = sqrt(v.squaredNorm() + kTiny);
  const T own = sqrt(j.qd.template head<2>().squaredNorm() + kTiny);
  const T over = speed - kLdpSlowest;
  const T clamped = 0.5 * (speed + kLdpSlowest + sqrt(over * over + kLdpSoftClamp * kLdpSoftClamp));
  const T ramp = 0.5 + (p[kNeighbourRange] - d) * (0.5 / kLdpFullGainSpan);
  const T under = ramp - 1.0;
  const T distance = 0.5 * (ramp + 1.0 - sqrt(under * under + kLdpSoftGain * kLdpSoftGain));
  return SoftStep<T>(p[kNeighbourRange] - d, kLdpSoftDistance) *
         SoftStep<T>(own - kLdpMovingSpeed, kLdpSoftSpeed) * clamped * distance;
}

struct PotentialTerm : ToEachOther<PotentialTerm> {
  template <typename T>
  static void AddOn(const ParameterSet<T>& p, const PendulumState<T>& n, const PendulumState<T>& j,
                    Vector4<T>* on_n, bool* acts) {
    const T gain = SmoothLdpGain(p, n, j);
    if (RealPart(gain) == 0.0) return;
    const Eigen::Matrix<T, 2, 1> r = n.q.template head<2>() - j.q.template head<2>();
    const Eigen::Matrix<T, 2, 1> v = j.qd.template head<2>() - n.qd.template head<2>();
    on_n->template head<2>() += gain * LdpRepulsion(p, r, v);
    *acts = true;
  }
};

struct LeanTerm : ToEachOther<LeanTerm> {
  // "I lean towards the neighbour, or the neighbour leans towards me", of two smooth switches;
  // side: +1 where the neighbour stands ahead (or to the left), -1 where behind. The caller weights
  // the two sides.
  template <typename T>
  static T TowardsEachOther(const T& mine, const T& theirs, double side) {
    const T a = SoftStep<T>(side * mine - kLdpLean, kLdpSoftLean);
    const T b = SoftStep<T>(-side * theirs - kLdpLean, kLdpSoftLean);
    return a + b - a * b;
  }

  template <typename T>
  static void AddOn(const ParameterSet<T>& p, const PendulumState<T>& n, const PendulumState<T>& j,
                    Vector4<T>* on_n, bool* acts) {
    const T gain = SmoothLdpGain(p, n, j);
    if (RealPart(gain) == 0.0) return;
    const T ahead = SoftStep<T>(j.q[0] - n.q[0], kLdpSoftSide);
    const T left = SoftStep<T>(j.q[1] - n.q[1], kLdpSoftSide);
    (*on_n)[2] += gain * p[kLeanTheta] *
                  ((1.0 - ahead) * TowardsEachOther<T>(n.q[2], j.q[2], -1.0) -
                   ahead * TowardsEachOther<T>(n.q[2], j.q[2], 1.0));
    // phi turns towards -y.
    (*on_n)[3] += gain * p[kLeanPhi] *
                  (left * TowardsEachOther<T>(-n.q[3], -j.q[3], 1.0) -
                   (1.0 - left) * TowardsEachOther<T>(-n.q[3], -j.q[3], -1.0));
    *acts = true;
  }
};

}  // namespace pushid
