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
//   own       what the laws that a user brings say (force_law.h).
// hold is the torque that holds the reference posture against gravity: zero for an upright one.
// Source: Yue et al., CVPR 2024 (PD balance, friction); the linear terms stand for its network.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "models/cart_damping.h"
#include "models/force_law.h"
#include "models/ipm.h"
#include "models/options.h"
#include "models/parameters.h"

namespace pushid {

// How fast stepping feet (stance.h) get their speed, 1/s: within 20 ms, or 0.6 steps of the rollout
// where these are longer.
double FootRate(double step);

// Factors from the reference person's gains to this body's, with the rod of frame 0: gains are the
// person's, not the posture's.
struct GainScale {
  double force = 1.0;      // on N s/m
  double stiffness = 1.0;  // on N m/rad
  double damping = 1.0;    // on N m s/rad

  GainScale(GainScaling scaling, const Body& body) {
    if (scaling == GainScaling::kNone) return;
    force = stiffness = damping = body.mass / kReferenceMass;
    if (scaling == GainScaling::kMass) return;
    const double rod = body.rod_length / kReferenceRod;
    stiffness *= rod;
    damping *= rod * rod;
  }
};

// One person's self force, with everything constant over a rollout computed once.
struct SelfForce {
  Body body;
  GainScale scale;
  FrictionKind friction;
  bool cart_derivative;
  Eigen::Vector2d posture;  // reference (theta, phi), rad
  Eigen::Vector2d hold;     // N m
  double dt;                // s, for the backward difference
  // Of feet that stand and step (stance.h): 1/s, sqrt(g / l); the hip before the cart in the
  // reference posture, m; how fast stepping feet get their speed, 1/s.
  double capture_rate;
  Eigen::Vector2d rest_offset;
  double foot_rate;
  std::vector<std::shared_ptr<const ForceLaw>> laws;  // the user's own

  // q0: the pose at frame 0.
  SelfForce(const ModelOptions& options, const Body& person, const Vector4<double>& q0, double step)
      : body(person),
        scale(options.gain_scaling, person),
        friction(options.friction),
        cart_derivative(options.cart_derivative == CartDerivative::kBackward),
        posture(Eigen::Vector2d::Zero()),
        hold(Eigen::Vector2d::Zero()),
        dt(step),
        capture_rate(std::sqrt(kGravity / person.rod_length)),
        rest_offset(Eigen::Vector2d::Zero()),
        foot_rate(FootRate(step)),
        laws(options.own_laws) {
    if (options.posture == Posture::kInitial) {
      posture = q0.tail<2>();
      hold = Gravity(person, q0).tail<2>();
      rest_offset = (HipPosition(person, q0).head<2>() - q0.head<2>());
    }
  }

  template <typename T>
  Vector4<T> Friction(const ParameterSet<T>& p, const Vector4<T>& qd) const {
    return {-scale.force * p[kMu] * qd[0], -scale.force * p[FrictionAlongY(friction)] * qd[1],
            T(0.0), T(0.0)};
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

  // The rows of the cart, and all.
  template <typename T>
  Eigen::Matrix<T, 2, 1> LinearOnCart(const ParameterSet<T>& p,
                                      const PendulumState<T>& state) const {
    const double mass = body.mass;
    const Vector4<T>& qd = state.qd;
    const T e_th = state.q[2] - posture[0], e_ph = state.q[3] - posture[1];
    const T speed = SmoothNorm(qd[0], qd[1]);
    return {mass * (p[kAx] * e_th + p[kBx] * qd[2] - p[kCq] * speed * qd[0]),
            mass * (-p[kAy] * e_ph - p[kBy] * qd[3] - p[kCq] * speed * qd[1])};
  }
  template <typename T>
  Vector4<T> Linear(const ParameterSet<T>& p, const PendulumState<T>& state) const {
    const double mass = body.mass, ml2 = PointInertia();
    const Vector4<T>& qd = state.qd;
    const Eigen::Matrix<T, 2, 1> cart = LinearOnCart(p, state);
    return {cart[0], cart[1],
            mass * p[kTx] * qd[0] - ml2 * p[kDq] * SmoothNorm(qd[2], T(0.0)) * qd[2],
            -mass * p[kTy] * qd[1] - ml2 * p[kDq] * SmoothNorm(qd[3], T(0.0)) * qd[3]};
  }

  // The laws that a user brings.
  template <typename T>
  Vector4<T> Own(const ParameterSet<T>& p, const PendulumState<T>& state) const {
    Vector4<T> force;
    force.setConstant(T(0.0));
    const T* own = p.data() + kFirstOwnParameter;
    for (const auto& law : laws) {
      force += law->Chain({body, posture}, state, own);
      own += law->parameters().size();
    }
    return force;
  }

  template <typename T>
  Vector4<T> Total(const ParameterSet<T>& p, const PendulumState<T>& state,
                   const Vector4<T>& qd_previous) const {
    Vector4<T> force = Friction(p, state.qd) + Balance(p, state, qd_previous) + Linear(p, state);
    if (!laws.empty()) force += Own(p, state);
    return force;
  }

  // Derivatives of Friction, and of Total. Friction's come from dual numbers over its own few
  // inputs, so that a law of friction is its formula and its rows; those of balance and the linear
  // terms are written out, which makes them some 30 times as fast (tests/benchmarks,
  // Jacobian_OfSelfForce), and tests hold them against automatic ones.
  // by_state: 4 x 8 over [q, qd]; by_previous: diagonal of the (x, y) derivatives by qd_previous;
  // by_parameter: 4 x kNumParameters. All are overwritten.
  struct Jacobian {
    Eigen::Matrix<double, 4, 8> by_state;
    Eigen::Vector2d by_previous;
    Eigen::Matrix<double, 4, kNumParameters> by_parameter;
  };
  void FrictionJacobian(const ParameterSet<double>& p, const Vector4<double>& qd,
                        Jacobian* jacobian) const;
  void TotalJacobian(const ParameterSet<double>& p, const PendulumState<double>& state,
                     const Vector4<double>& qd_previous, Jacobian* jacobian) const;
  // Of friction, balance and the linear terms, without the laws that a user brings; and these,
  // added.
  void MotionJacobian(const ParameterSet<double>& p, const PendulumState<double>& state,
                      const Vector4<double>& qd_previous, Jacobian* jacobian) const;
  void AddOwnJacobian(const ParameterSet<double>& p, const PendulumState<double>& state,
                      Jacobian* jacobian) const;

 private:
  void AddBalanceJacobian(const ParameterSet<double>& p, const PendulumState<double>& state,
                          const Vector4<double>& qd_previous, Jacobian* jacobian) const;
  void AddLinearJacobian(const ParameterSet<double>& p, const PendulumState<double>& state,
                         Jacobian* jacobian) const;
  double PointInertia() const { return body.point_mass() * body.rod_length * body.rod_length; }
  // |v| whose derivative exists at rest; 1e-3 (m/s or rad/s) is far below any motion that matters.
  static constexpr double kRestSpeedSquared = 1e-6;
  template <typename T>
  static T SmoothNorm(const T& a, const T& b) {
    using std::sqrt;
    return sqrt(a * a + b * b + kRestSpeedSquared);
  }
};

}  // namespace pushid
