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

// A person as standing and stepping (stance.h) see it: plain numbers, which have the same layout
// in files that are compiled for wider vectors (residuals/lanes).
struct StanceBody {
  double rod_length, dt;  // m, s
  double capture_rate;    // 1/s, sqrt(g / l)
  double weight;          // N: times the sine of the lean and the rod's length, gravity's torque
  double stiffness, damping;            // of the gain scales
  double hold[2];                       // N m
  double rest[2] = {0.0, 0.0};          // m: the hip before the cart in the reference posture
  double apart[2] = {0.0, kFeetApart};  // m: the left foot from the right one at frame 0
  bool among_others;                    // of a model of people who touch
};

// One person's self force, with everything constant over a rollout computed once.
struct SelfForce : SelfTerms<double> {
  StanceBody standing;
  Vector3<double> rest_direction = Vector3<double>::UnitZ();  // along the rod, of the posture
  std::vector<std::shared_ptr<const ForceLaw>> laws;          // the user's own

  // q0: the pose at frame 0.
  SelfForce(const ModelOptions& options, const Body& person, const Vector4<double>& q0, double step)
      : laws(options.own_laws) {
    body = person;
    scale = GainScale(options.gain_scaling, person);
    friction = options.friction;
    cart_derivative = options.cart_derivative == CartDerivative::kBackward;
    dt = step;
    if (options.posture == Posture::kInitial) {
      posture = q0.tail<2>();
      hold = Gravity(person, q0).tail<2>();
      for (int i = 0; i < 2; ++i) standing.rest[i] = HipPosition(person, q0)[i] - q0[i];
      const Angles<double> rest(q0);
      rest_direction = {rest.s_th, -rest.c_th * rest.s_ph, rest.c_th * rest.c_ph};
    }
    standing.rod_length = person.rod_length;
    standing.dt = dt;
    standing.capture_rate = std::sqrt(kGravity / person.rod_length);
    standing.weight = weight();
    standing.stiffness = scale.stiffness;
    standing.damping = scale.damping;
    for (int i = 0; i < 2; ++i) standing.hold[i] = hold[i];
    standing.among_others = options.interaction.Any();
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

  // The person's own part: all but friction, which is the ground's.
  template <typename T>
  Vector4<T> Effort(const ParameterSet<T>& p, const PendulumState<T>& state,
                    const Vector4<T>& qd_previous) const {
    Vector4<T> force = Balance(p, state, qd_previous) + Linear(p, state);
    if (!laws.empty()) force += Own(p, state);
    return force;
  }
};

}  // namespace pushid
