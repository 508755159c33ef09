// models: all that a person does about being pushed: the terms of self_terms.h, and
//   own       what the laws that a user brings say (force_law.h).
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <memory>
#include <vector>

#include "models/force_law.h"
#include "models/self_terms.h"

namespace pushid {

inline constexpr double kHeldFast = 1e8;  // 1/s, times the mass: the ground on feet that hold

// One person's self force, with everything constant over a rollout computed once.
struct SelfForce : SelfTerms<double> {
  // Of feet that stand and step (stance.h): 1/s, sqrt(g / l); the hip before the cart in the
  // reference posture, m; the left foot from the right one at frame 0, m.
  double capture_rate;
  Eigen::Vector2d rest_offset;
  Eigen::Vector2d feet_apart = {0.0, kFeetApart};
  bool among_others;                                          // of a model of people who touch
  Vector3<double> rest_direction = Vector3<double>::UnitZ();  // along the rod, of the posture
  std::vector<std::shared_ptr<const ForceLaw>> laws;          // the user's own

  // q0: the pose at frame 0.
  SelfForce(const ModelOptions& options, const Body& person, const Vector4<double>& q0, double step)
      : capture_rate(std::sqrt(kGravity / person.rod_length)),
        rest_offset(Eigen::Vector2d::Zero()),
        among_others(options.interaction.Any()),
        laws(options.own_laws) {
    body = person;
    scale = GainScale(options.gain_scaling, person);
    friction = options.friction;
    cart_derivative = options.cart_derivative == CartDerivative::kBackward;
    dt = step;
    if (options.posture == Posture::kInitial) {
      posture = q0.tail<2>();
      hold = Gravity(person, q0).tail<2>();
      rest_offset = (HipPosition(person, q0).head<2>() - q0.head<2>());
      const Angles<double> rest(q0);
      rest_direction = {rest.s_th, -rest.c_th * rest.s_ph, rest.c_th * rest.c_ph};
    }
  }

  // N: times the sine of the lean and the rod's length, gravity's torque.
  double weight() const { return kGravity * body.point_mass() * body.pendulum_ratio; }

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

  // Derivatives of Total; of the laws that a user brings, added.
  using Jacobian = SelfJacobian<double>;
  void TotalJacobian(const ParameterSet<double>& p, const PendulumState<double>& state,
                     const Vector4<double>& qd_previous, Jacobian* jacobian) const;
  void AddOwnJacobian(const ParameterSet<double>& p, const PendulumState<double>& state,
                      Jacobian* jacobian) const;
};

}  // namespace pushid
