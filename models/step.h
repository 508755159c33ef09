// models: one step of the model, from everybody's state at a frame to that at the next.
//
//   M(q) qdd + C(q, qd) + G(q) = F_net,   qd <- qd + dt qdd,   q <- q + dt qd        (ipm.h)
//
// All of it, from top to bottom: drag and balance, by what the feet do; then all that acts on one
// person; the acceleration; the next state; and everybody. A law is one formula, in the file named
// beside its call, and one row (options.h, parameters.h). Templated, so that the same lines serve
// doubles and jets; step_memory.h holds what lasts longer than a step.
#pragma once

#include <vector>

#include "models/stance.h"
#include "models/standing.h"
#include "models/step_memory.h"

namespace pushid {

// Drag and balance of feet that slide. late: what control perceives; null where it is not late.
template <typename T>
void AddSliding(const SelfForce& self, const ParameterSet<T>& p, ActiveForces active,
                const PendulumState<T>& state, const Vector4<T>& qd_previous,
                const Perceived<T>* late, NetForce<T>* force) {
  if (active == ActiveForces::kPushOnly) return;
  (*force)[ForcePart::kFriction] = self.Friction(p, state.qd);  // self_terms.h, as all here
  if (active == ActiveForces::kPushAndFriction) return;
  Vector4<T>&balance = (*force)[ForcePart::kBalance], &linear = (*force)[ForcePart::kLinear];
  const PendulumState<T>& of_cart = late != nullptr ? late->step : state;
  balance = self.Balance(p, of_cart, qd_previous);
  linear = self.Linear(p, of_cart);
  if (late == nullptr) return;
  balance.template tail<2>() = self.Balance(p, late->ankle, qd_previous).template tail<2>();
  linear.template tail<2>() = self.Linear(p, late->ankle).template tail<2>();
}

// Balance of feet that hold and step (stance.h): nothing slides, the ankles balance.
template <typename T>
void AddStepping(const SelfForce& self, const ParameterSet<T>& p, ActiveForces active,
                 const PosedPendulum<T>& state, const Perceived<T>* late, NetForce<T>* force) {
  const StanceParameters<T> stance(p);
  const StanceForces<T> feet =
      late != nullptr ? StanceAt(self.standing, stance, state.feet, PosedPendulum<T>(late->ankle),
                                 PosedPendulum<T>(late->step))
                      : StanceAt(self.standing, stance, state.feet, state, state);
  force->next_feet = feet.next;
  if (active != ActiveForces::kAll) return;
  force->ground = T(kHeldFast * self.body.mass);
  force->feet_velocity = feet.velocity;
  (*force)[ForcePart::kBalance].template tail<2>() = feet.torque;
}

// Balance of feet that never move (standing.h).
template <typename T>
void AddStanding(const SelfForce& self, const ParameterSet<T>& p, const PendulumState<T>& felt,
                 NetForce<T>* force) {
  force->ground = T(kHeldFast * self.body.mass);
  (*force)[ForcePart::kBalance].template tail<2>() =
      StandingTorque(self, p, Angles<T>(felt.q), felt.qd);
}

// The net force on one person. received: the forces of neighbours (interaction.h); network: the
// output of the person's network (self_network.h).
template <typename T>
NetForce<T> NetForceAt(const Scene& scene, const ModelOptions& options, const SelfForce& self,
                       const ParameterSet<T>& p, int person, int frame,
                       const PosedPendulum<T>& state, const Vector4<T>& qd_previous,
                       const Vector4<T>& received = Vector4<T>::Zero(),
                       const Vector4<T>& network = Vector4<T>::Zero(),
                       const Perceived<T>* late = nullptr) {
  NetForce<T> force;
  force.angles = state.angles;
  const bool slides = options.stance == Stance::kSlide, table = options.body == BodyModel::kTable;
  const ActiveForces active = ForcesAt(scene, options.push, person, frame);
  force[ForcePart::kPush] = PushForceAt(scene, person, frame).template cast<T>();
  if (table) force[ForcePart::kPush] *= p[kPushGain];
  if (slides) AddSliding(self, p, active, state, qd_previous, late, &force);
  if (options.stance == Stance::kSteps) AddStepping(self, p, active, state, late, &force);
  if (options.stance == Stance::kFixed && active == ActiveForces::kAll) {
    AddStanding<T>(self, p, late != nullptr ? late->ankle : state, &force);
  }
  if (!slides && active == ActiveForces::kPushAndFriction) {
    force[ForcePart::kFriction].template head<2>() =
        T(-kPublishedFriction) * state.qd.template head<2>();
  }
  if (scene.ground.moves()) {  // ground.h, which also has what platforms see of the step
    const BodyOf<T> body = DynamicBody(options, self.body, p, force.HoldsFast(options.stance));
    force[ForcePart::kInertia] = GroundForce<T, T>(body, force.angles, scene.ground.StepAt(frame));
  }
  if (active != ActiveForces::kAll) return force;
  if (table) force[ForcePart::kBalance].template tail<2>() += HoldOfTable(self, p);
  // The tail stands here alone: a push that is the whole force includes the tail of an earlier one.
  for (const ScenePush& push : scene.pushes) {
    if (push.person != person || !HasTail(options)) continue;
    force[ForcePart::kTail] +=
        slides ? TailForce(push, self.body.mass, p, frame, scene.dt)  // push.h
               : TailForceAtHip(push, p, self.body, force.angles, frame, scene.dt);
  }
  if (!self.laws.empty()) force[ForcePart::kOwn] = self.Own(p, state);  // force_law.h
  force[ForcePart::kInteraction] = received;
  force[ForcePart::kNetwork] = network;
  return force;
}

// The step of everybody in a scene. Frame by frame: Update, Prepare for each person or PrepareAll,
// then On, AccelerationOf and Next, in any order and from any thread (each with its own scratch).
template <typename T>
class ModelStep : public StepMemory<T> {
 public:
  using StepMemory<T>::StepMemory;

  // qd_previous: the velocity one frame earlier.
  NetForce<T> On(int n, int frame, const Vector4<T>& qd_previous) const {
    return NetForceAt(*this->scene_, *this->options_, this->self(n), this->Parameters(n), n, frame,
                      this->state(n), qd_previous, this->received(n), this->network(n),
                      this->perceived(n));
  }

  Vector4<T> AccelerationOf(int n, const NetForce<T>& force) const {
    const Body& body = this->self(n).body;
    const ParameterSet<T>& p = this->Parameters(n);
    const PendulumState<T>& state = this->state(n);
    const Vector4<T> total = force.Total();
    const auto on_ground = [&](const auto& moving) {
      return AccelerationOnGround(moving, force.angles, state.qd, total, force.ground,
                                  force.feet_velocity, this->scene_->dt);
    };
    const Stance stance = this->options_->stance;
    if (force.HoldsFast(stance)) return on_ground(StandingBody<T>(body, p[kComHeight]));
    if (stance == Stance::kSteps) return on_ground(body);
    const auto free = [&](const auto& moving) {
      return Acceleration(moving, force.angles, state.qd, total);
    };
    if (this->options_->body == BodyModel::kTable) return free(TableBody(body, p));
    return this->rod_moves() ? free(BodyNow(body, state.rod)) : free(body);
  }

  // The pendulum under qdd, the feet and, where the model has a law for it, the rod.
  PendulumState<T> Next(int n, const Vector4<T>& qdd, const NetForce<T>& force,
                        const Vector4<T>& qd_previous) {
    const double dt = this->scene_->dt;
    PendulumState<T> next = Step(this->state(n), qdd, dt);
    if (this->options_->stance == Stance::kSteps) next.feet = force.next_feet;
    if (this->rod_moves()) next.rod += dt * this->RodVelocityOf(n, qd_previous);
    return next;
  }
};

}  // namespace pushid
