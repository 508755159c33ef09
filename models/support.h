// models: the feet of who stands and steps: parameters, the hip over them, their support.
//
// The letters are those of stance.h, which has the equations.
#pragma once

#include <cmath>

#include "models/self_force.h"

namespace pushid {

inline constexpr double kSupportEdge = 0.05;         // of rho: where a step begins to be prepared
inline constexpr double kPublishedFriction = 100.0;  // N s/m, taken out of net_without_friction

// The numbers of the law without a name.
struct StanceNumbers {
  static constexpr double kRushEdge = 0.2;  // of S
  // Among others: by how much S makes a swing quicker; 1 / the share of t_on after which they fall.
  static constexpr double kQuicker = 0.25, kLetsFall = 3.0;
  static constexpr double kForgets = 0.2;       // s, until a step is not prepared any more
  static constexpr double kBringsUp = 0.6;      // s, until the rear foot is brought up
  static constexpr double kAgain = 0.06;        // s, between two steps of who is not caught yet
  static constexpr double kShortStride = 0.02;  // m
  // m, of half a stride and of a stride: feet farther apart than that take turns; the rear one
  // goes.
  static constexpr double kAbreast = 0.02, kStaggered = 0.15;
  static constexpr double kFootSpeed = 4.4;  // m/s
  static constexpr double kCaptureGain = 2.5;
  static constexpr double kFootBack = 0.05, kFootSide = 0.03, kLeastReach = 0.02;  // m
  static constexpr double kReach = 1.2;      // of the rod: the longest step
  static constexpr double kSideReach = 0.4;  // m: the longest to the side
};

// The parameters of stance.
template <typename T>
struct StanceParameters {
  T Kp[2], Kd[2], front, back, side, foot_front, gain, onset, swing;

  explicit StanceParameters(const ParameterSet<T>& p)
      : Kp{p[kKpTheta], p[kKpPhi]},
        Kd{p[kKdTheta], p[kKdPhi]},
        front(p[kSupportFront]),
        back(p[kSupportBack]),
        side(p[kSupportSide]),
        foot_front(p[kFootFront]),
        gain(p[kStepGain]),
        onset(p[kStepOnset]),
        swing(p[kStepSwing]) {}
};

template <typename T>
using Horizontal = Eigen::Matrix<T, 2, 1>;

// The hip and its velocity, from the ankles; of the rod of frame 0.
template <typename T>
struct HipOverFeet {
  Horizontal<T> place, velocity, cart;  // cart: its velocity

  HipOverFeet() = default;
  HipOverFeet(const StanceBody& body, const Angles<T>& angles, const Vector4<T>& qd) {
    const double l = body.rod_length;
    const auto& [s_th, c_th, s_ph, c_ph] = angles;
    place = {l * s_th, -l * c_th * s_ph};
    cart = {qd[0], qd[1]};
    velocity = {qd[0] + l * c_th * qd[2], qd[1] + l * (s_th * s_ph * qd[2] - c_th * c_ph * qd[3])};
  }
  // xi above.
  Horizontal<T> Capture(const StanceBody& body) const {
    return place + (1.0 / body.capture_rate) * velocity;
  }
};

// d above.
template <typename T>
Horizontal<T> HalfApart(const FeetState<T>& feet) {
  const auto half = [](const T& apart) -> T {
    return (RealPart(apart) < 0.0 ? -0.5 : 0.5) * apart;
  };
  return {half(feet.apart[0]), half(feet.apart[1])};
}

// The distance of xi (relative to the ankles along x, to its resting place along y) over the extent
// of the support in that direction, for feet that are 2 d apart; 1 at the edge.
template <typename T>
T SupportRatio(const StanceParameters<T>& p, const Horizontal<T>& xi, const Horizontal<T>& d) {
  using std::sqrt;
  constexpr double kTiny = 1e-12;  // a derivative also at rest
  const T x = xi[0] / ((RealPart(xi[0]) < 0.0 ? p.back : p.front) + d[0]);
  const T y = xi[1] / (p.side + d[1]);
  return sqrt(x * x + y * y + kTiny);
}

// x limited to -most .. most: smooth, and within 9 % of x up to 0.8 most.
template <typename T>
T SmoothLimit(const T& x, const T& most) {
  using std::sqrt;
  const T x2 = x * x, most2 = most * most;
  return x * most / sqrt(sqrt(x2 * x2 + most2 * most2));
}

// 0 to 1 while u goes from 0 to 1, without a jerk.
template <typename T>
T SmoothRise(const T& u) {
  if (RealPart(u) <= 0.0) return T(0.0);
  if (RealPart(u) >= 1.0) return T(1.0);
  return u * u * (3.0 - 2.0 * u);
}

}  // namespace pushid
