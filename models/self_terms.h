// models: what a person does about being pushed: balance, ground friction and the linear self
// force, a generalized force [N, N, N m, N m] that depends on the own state alone.
//
// With e = (theta, phi) minus the reference posture, v = (xd, yd), and the gain scales of
// GainScale:
//   friction  F_x = -mu xd                      F_y = -mu_y yd
//   balance   F_x = -Kp_x xd - Kd_x xdd         F_y = -Kp_y yd - Kd_y ydd
//             F_theta = hold_theta - Kp_theta e_theta - Kd_theta thd
//   linear    F_x = M (a_x e_theta + b_x thd - c_q |v| xd)
//             F_theta = M t_x xd - m l^2 d_q |thd| thd
// and the same for y and phi, where a, b and t change sign, because phi turns towards -y;
// hold is the torque that holds the reference posture against gravity: zero for an upright one.
// Source: Yue et al., CVPR 2024 (PD balance, friction); the linear terms stand for its network.
//
// Templated by the scalar T of states and parameters, and by that of what is constant, L: double
// for one person, a vector for several side by side (residuals/lanes).
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <string_view>

#include "models/ipm.h"
#include "models/jet.h"
#include "models/options.h"
#include "models/parameters.h"

namespace pushid {

// Laws of friction of the cart (FrictionKind), without branches, since a scalar may hold several
// people. scale: of forces; p: the parameters from kMu up to kKpX; weight: N.
struct LinearDrag {
  template <typename T, typename L, typename Set>
  static Vector4<T> Force(const L& scale, const Set& p, Parameter along_y, const Vector4<T>& qd,
                          const L& /*weight*/) {
    return {-scale * p[kMu] * qd[0], -scale * p[along_y] * qd[1], T(0.0), T(0.0)};
  }
};

// Viscous and dry friction: -mu v - mu_c M g v / sqrt(v^2 + v_0^2), which holds no cart still but
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

// The convention by which mu is told from Kp.
//
// Friction and the balance gain act on the same velocity, so the data know only their sum,
//   c_x = mu + Kp_x,   c_y = mu_y + Kp_y   (mu_y: FrictionAlongY), N s/m.
// A fit holds Kp_x and Kp_y, fits c by way of mu, and says so: mu = c - Kp. Kp free as well leaves
// the two unidentifiable, which the fit then reports.
struct CartDamping {
  std::string_view name;
  Parameter friction;  // derived: c - gain
  Parameter gain;      // held

  template <typename T>
  T Of(const ParameterSet<T>& p) const {
    return p[friction] + p[gain];
  }
};

// The parameter that is the drag along y as mu is along x.
constexpr Parameter FrictionAlongY(FrictionKind kind) {
  return kind == FrictionKind::kAnisotropic ? kMuY : kMu;
}

// Along x, and along y.
constexpr std::array<CartDamping, 2> CartDampings(FrictionKind kind) {
  return {CartDamping{"c_x", kMu, kKpX}, CartDamping{"c_y", FrictionAlongY(kind), kKpY}};
}

// A parameter that acts sideways, and the one that acts forwards as it does
// (Directions::kIsotropic).
struct SidewaysParameter {
  Parameter sideways, forward;
};
inline constexpr SidewaysParameter kSidewaysParameters[] = {
    {kKpY, kKpX}, {kKpPhi, kKpTheta}, {kKdY, kKdX}, {kKdPhi, kKdTheta},
    {kAy, kAx},   {kBy, kBx},         {kTy, kTx}};

// Whether a parameter is one that the convention holds.
constexpr bool HeldByConvention(Parameter id) { return id == kKpX || id == kKpY; }

// Factors from the reference person's gains to this body's, with the rod of frame 0: gains are the
// person's, not the posture's.
template <typename L>
struct GainScaleOf {
  L force = L(1.0);      // on N s/m
  L stiffness = L(1.0);  // on N m/rad
  L damping = L(1.0);    // on N m s/rad

  GainScaleOf() = default;
  GainScaleOf(GainScaling scaling, const BodyOf<L>& body) {
    if (scaling == GainScaling::kNone) return;
    force = stiffness = damping = body.mass / kReferenceMass;
    if (scaling == GainScaling::kMass) return;
    const L rod = body.rod_length / kReferenceRod;
    stiffness *= rod;
    damping *= rod * rod;
  }
};

using GainScale = GainScaleOf<double>;

// One person's terms, with everything constant over a rollout computed once.
template <typename L>
struct SelfTerms {
  BodyOf<L> body;
  GainScaleOf<L> scale;
  FrictionKind friction = FrictionKind::kIsotropic;
  bool cart_derivative = false;
  Eigen::Matrix<L, 2, 1> posture = Eigen::Matrix<L, 2, 1>::Zero();  // reference (theta, phi), rad
  Eigen::Matrix<L, 2, 1> hold = Eigen::Matrix<L, 2, 1>::Zero();     // N m
  L dt = L(0.0);  // s, for the backward difference

  // p: by Parameter, of friction's own at least.
  template <typename T, typename Set>
  Vector4<T> Friction(const Set& p, const Vector4<T>& qd) const {
    const Parameter along_y = FrictionAlongY(friction);
    const L weight(body.mass * kGravity);
    switch (friction) {
      case FrictionKind::kIsotropic:
      case FrictionKind::kAnisotropic:
        break;
      case FrictionKind::kCoulomb:
        return CoulombDrag::Force<T>(scale.force, p, along_y, qd, weight);
    }
    return LinearDrag::Force<T>(scale.force, p, along_y, qd, weight);
  }

  // qd_previous: the velocity one frame earlier, for the backward difference of the cart's
  // velocity.
  template <typename T>
  Vector4<T> Balance(const ParameterSet<T>& p, const PendulumState<T>& state,
                     const Vector4<T>& qd_previous) const {
    const Vector4<T>& qd = state.qd;
    Vector4<T> force{-scale.force * p[kKpX] * qd[0], -scale.force * p[kKpY] * qd[1],
                     hold[0] - scale.stiffness * p[kKpTheta] * (state.q[2] - posture[0]) -
                         scale.damping * p[kKdTheta] * qd[2],
                     hold[1] - scale.stiffness * p[kKpPhi] * (state.q[3] - posture[1]) -
                         scale.damping * p[kKdPhi] * qd[3]};
    if (cart_derivative) {
      force[0] -= scale.force * p[kKdX] * (qd[0] - qd_previous[0]) / dt;
      force[1] -= scale.force * p[kKdY] * (qd[1] - qd_previous[1]) / dt;
    }
    return force;
  }

  template <typename T>
  Vector4<T> Linear(const ParameterSet<T>& p, const PendulumState<T>& state) const {
    const L mass = body.mass, ml2 = PointInertia();
    const Vector4<T>& qd = state.qd;
    const T e_th = state.q[2] - posture[0], e_ph = state.q[3] - posture[1];
    const T speed = SmoothNorm(qd[0], qd[1]);
    return {mass * (p[kAx] * e_th + p[kBx] * qd[2] - p[kCq] * speed * qd[0]),
            mass * (-p[kAy] * e_ph - p[kBy] * qd[3] - p[kCq] * speed * qd[1]),
            mass * p[kTx] * qd[0] - ml2 * p[kDq] * SmoothNorm(qd[2], T(0.0)) * qd[2],
            -mass * p[kTy] * qd[1] - ml2 * p[kDq] * SmoothNorm(qd[3], T(0.0)) * qd[3]};
  }

  L PointInertia() const {
    return body.point_mass() * body.pendulum_length() * body.pendulum_length();
  }
  // |v| whose derivative exists at rest; 1e-3 (m/s or rad/s) is far below any motion that matters.
  static constexpr double kRestSpeedSquared = 1e-6;
  template <typename T>
  static T SmoothNorm(const T& a, const T& b) {
    using std::sqrt;
    return sqrt(a * a + b * b + kRestSpeedSquared);
  }
};

}  // namespace pushid
