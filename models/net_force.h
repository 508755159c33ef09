// models: the net force on one person in one step, by parts.
//
//   F_net = the sum of the parts of options.h, where by push kind (push.h)
//   and PushUse (options.h) a `net` push may replace all other forces, and a `net_without_friction`
//   push all but the friction, while it lasts. Where feet stand and step (stance.h), what a person
//   does about being pushed depends on the feet as well.
//
// Templated, so that the same lines serve doubles and automatic differentiation.
#pragma once

#include <array>
#include <vector>

#include "models/interaction.h"
#include "models/ipm.h"
#include "models/options.h"
#include "models/parameters.h"
#include "models/reaction_delay.h"
#include "models/scene.h"
#include "models/self_force.h"
#include "models/stance.h"
#include "models/standing.h"

namespace pushid {

// Which forces act on a person during one step.
enum class ActiveForces { kAll, kPushAndFriction, kPushOnly };

ActiveForces ForcesAt(const Scene& scene, PushUse use, int person, int frame);

// The force of all pushes on a person in one step, without tails. Constant in the parameters.
Vector4<double> PushForceAt(const Scene& scene, int person, int frame);

// The parts of F_net on one person in one step (options.h).
template <typename T>
struct NetForce {
  std::array<Vector4<T>, kNumForceParts> parts;
  Angles<T> angles;  // of the state at which it acts
  // Where feet hold: the ground's resistance (N s/m) to what the cart's velocity after the step is
  // more than that of the feet, a part of the friction once that is known (AddGround); where they
  // step as well, the feet after the step.
  T ground = T(0.0);
  Horizontal<T> feet_velocity{T(0.0), T(0.0)};  // m/s, of the middle between them
  FeetState<T> next_feet;

  NetForce() { parts.fill(Vector4<T>::Zero()); }
  Vector4<T>& operator[](ForcePart part) { return parts[static_cast<int>(part)]; }
  const Vector4<T>& operator[](ForcePart part) const { return parts[static_cast<int>(part)]; }

  Vector4<T> Total() const {
    Vector4<T> sum = parts[0];
    for (int i = 1; i < kNumForceParts; ++i) sum += parts[i];
    return sum;
  }

  void AddGround(const Vector4<T>& next_qd) {
    for (int i = 0; i < 2; ++i) {
      (*this)[ForcePart::kFriction][i] -= ground * (next_qd[i] - feet_velocity[i]);
    }
  }
};

// The parts that reports list: all but for noise, for a user's own laws where the model has none,
// and for inertia, which files list where the ground moves.
std::vector<ForcePart> ReportedParts(const ModelOptions& options);

// What a person does about being pushed: friction, balance and the linear terms.
template <typename T>
void AddSlidingForces(const SelfForce& self, const ParameterSet<T>& p, ActiveForces active,
                      const PendulumState<T>& state, const Vector4<T>& qd_previous,
                      NetForce<T>* force, const Perceived<T>* perceived) {
  if (active == ActiveForces::kPushOnly) return;
  (*force)[ForcePart::kFriction] = self.Friction(p, state.qd);
  if (active == ActiveForces::kPushAndFriction) return;
  Vector4<T>& balance = (*force)[ForcePart::kBalance];
  Vector4<T>& linear = (*force)[ForcePart::kLinear];
  const PendulumState<T>& of_cart = perceived != nullptr ? perceived->step : state;
  balance = self.Balance(p, of_cart, qd_previous);
  linear = self.Linear(p, of_cart);
  if (perceived == nullptr) return;
  balance.template tail<2>() = self.Balance(p, perceived->ankle, qd_previous).template tail<2>();
  linear.template tail<2>() = self.Linear(p, perceived->ankle).template tail<2>();
}

// The body of a rollout: of who slides or steps; where the table has its masses, those.
template <typename T>
BodyOf<T> TableBody(const Body& body, const ParameterSet<T>& p) {
  return Distributed<T>(body, {p[kCartMassShare], p[kComHeight], p[kGyrationRadius]});
}

// What holds the posture of a body with the table's masses, less what holds that of its own.
template <typename T>
Eigen::Matrix<T, 2, 1> HoldOfTable(const SelfForce& self, const ParameterSet<T>& p) {
  const BodyOf<T> body = TableBody(self.body, p);
  const double own = self.body.point_share * self.body.pendulum_ratio;
  const T more = body.point_share * body.pendulum_ratio / own - 1.0;
  return {more * self.hold[0], more * self.hold[1]};
}

// What was taken out of a `net_without_friction` push.
template <typename T>
void AddPublishedFriction(const PendulumState<T>& state, NetForce<T>* force) {
  for (int i = 0; i < 2; ++i) {
    (*force)[ForcePart::kFriction][i] = -kPublishedFriction * state.qd[i];
  }
}

// As above, for feet that stand and step: nothing slides, so neither drag nor the terms of a
// sliding cart act.
template <typename T>
void AddStanceForces(const SelfForce& self, const ParameterSet<T>& p, ActiveForces active,
                     const PosedPendulum<T>& state, const Perceived<T>* late, NetForce<T>* force) {
  const StanceParameters<T> stance([&p](Parameter id) { return p[id]; });
  const StanceForces<T> of_stance =
      late != nullptr ? StanceAt(self.standing, stance, state.feet, PosedPendulum<T>(late->ankle),
                                 PosedPendulum<T>(late->step))
                      : StanceAt(self.standing, stance, state.feet, state, state);
  force->next_feet = of_stance.next;
  if (active == ActiveForces::kPushAndFriction) AddPublishedFriction(state, force);
  if (active != ActiveForces::kAll) return;
  force->ground = T(kHeldFast * self.body.mass);
  force->feet_velocity = of_stance.velocity;
  (*force)[ForcePart::kBalance].template tail<2>() = of_stance.torque;
}

// As above, for feet that never move. felt: the delayed state to which the ankles react. While a
// push is the whole force, its rows hold the feet's reaction.
template <typename T>
void AddStandingForces(const SelfForce& self, const ParameterSet<T>& p, ActiveForces active,
                       const PendulumState<T>& state, const PendulumState<T>& felt,
                       NetForce<T>* force) {
  if (active == ActiveForces::kPushAndFriction) AddPublishedFriction(state, force);
  if (active != ActiveForces::kAll) return;
  const StandingParameters<T> standing([&p](Parameter id) { return p[id]; });
  force->ground = T(kHeldFast * self.body.mass);
  (*force)[ForcePart::kBalance].template tail<2>() =
      StandingTorque(self, standing, Angles<T>(felt.q), felt.qd);
}

// The body whose equations of motion a step has.
template <typename T>
BodyOf<T> DynamicBody(const ModelOptions& options, const Body& body, const ParameterSet<T>& p,
                      bool holds_fast) {
  if (holds_fast) return StandingBody<T>(body, p[kComHeight]);
  if (options.body == BodyModel::kTable) return TableBody(body, p);
  return BodyNow<T>(body, T(0.0), T(0.0));
}

// received: from others; network: what the person's own network answers; perceived: where control
// is late.
template <typename T>
NetForce<T> NetForceAt(const Scene& scene, const ModelOptions& options, const SelfForce& self,
                       const ParameterSet<T>& p, int person, int frame,
                       const PosedPendulum<T>& state, const Vector4<T>& qd_previous,
                       const Vector4<T>& received = Vector4<T>::Zero(),
                       const Vector4<T>& network = Vector4<T>::Zero(),
                       const Perceived<T>* perceived = nullptr) {
  NetForce<T> force;
  force.angles = state.angles;
  force[ForcePart::kPush] = PushForceAt(scene, person, frame).template cast<T>();
  if (options.body == BodyModel::kTable) force[ForcePart::kPush] *= p[kPushGain];
  const ActiveForces active = ForcesAt(scene, options.push, person, frame);
  switch (options.stance) {
    case Stance::kSlide:
      AddSlidingForces(self, p, active, state, qd_previous, &force, perceived);
      break;
    case Stance::kSteps:
      AddStanceForces(self, p, active, state, perceived, &force);
      break;
    case Stance::kFixed:
      AddStandingForces<T>(self, p, active, state, perceived != nullptr ? perceived->ankle : state,
                           &force);
      break;
  }
  if (scene.ground.moves()) {
    const bool holds = options.stance == Stance::kFixed && RealPart(force.ground) > 0.0;
    force[ForcePart::kInertia] = GroundForce<T, T>(DynamicBody(options, self.body, p, holds),
                                                   force.angles, scene.ground.StepAt(frame));
  }
  if (options.body == BodyModel::kTable && active == ActiveForces::kAll) {
    force[ForcePart::kBalance].template tail<2>() += HoldOfTable(self, p);
  }
  if (active != ActiveForces::kAll) return force;
  // Only here: a push that is the whole force includes the tail of an earlier one.
  if (options.push_tail == PushTail::kExponential && options.stance != Stance::kFixed) {
    const bool stands = options.stance == Stance::kSteps;
    for (const ScenePush& push : scene.pushes) {
      if (push.person != person) continue;
      force[ForcePart::kTail] +=
          stands ? TailForceAtHip(push, p, self.body, force.angles, frame, scene.dt)
                 : TailForce(push, self.body.mass, p, frame, scene.dt);
    }
  }
  if (!self.laws.empty()) force[ForcePart::kOwn] = self.Own(p, state);
  force[ForcePart::kInteraction] = received;
  force[ForcePart::kNetwork] = network;
  return force;
}

// The parts of the net force that drove a rollout, for reports; the last frame's drive no step.
using ForceTrace = FrameTable<NetForce<double>>;

}  // namespace pushid
