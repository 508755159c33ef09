// models: the rollout of a scene, frame by frame: M qdd + C + G = F_net, semi-implicit Euler.
//
//   F_net = self force + push + tail, where by push kind and PushUse (DESIGN section 3) a `net`
//   push may replace all self forces, and a `net_without_friction` push all but the friction, while
//   it lasts.
//
// Templated, so that the same lines serve doubles and automatic differentiation.
#pragma once

#include <cmath>
#include <string_view>
#include <vector>

#include "models/contact.h"
#include "models/ipm.h"
#include "models/options.h"
#include "models/parameters.h"
#include "models/scene.h"
#include "models/self_force.h"

namespace pushid {

// Whether a rollout stayed in the model's domain, and if not, where it left it.
struct RolloutStatus {
  bool ok = true;
  int frame = 0;
  int person = 0;
  std::string_view quantity;  // theta, phi or "state" (not finite)
};

// Which forces act on a person during one step.
enum class ActiveForces { kAll, kPushAndFriction, kPushOnly };

ActiveForces ForcesAt(const Scene& scene, PushUse use, int person, int frame);

// The force of all pushes on a person in one step, without tails. Constant in the parameters.
Vector4<double> PushForceAt(const Scene& scene, int person, int frame);

// The parts of F_net on one person in one step, for reports.
template <typename T>
struct NetForce {
  Vector4<T> friction = Vector4<T>::Zero();
  Vector4<T> balance = Vector4<T>::Zero();
  Vector4<T> linear = Vector4<T>::Zero();
  Vector4<T> push = Vector4<T>::Zero();
  Vector4<T> tail = Vector4<T>::Zero();
  Vector4<T> interaction = Vector4<T>::Zero();

  Vector4<T> Total() const { return friction + balance + linear + push + tail + interaction; }
};

template <typename T>
NetForce<T> NetForceAt(const Scene& scene, const ModelOptions& options, const SelfForce& self,
                       const ParameterSet<T>& p, int person, int frame,
                       const PendulumState<T>& state, const Vector4<T>& qd_previous,
                       const Vector4<T>& interaction = Vector4<T>::Zero()) {
  NetForce<T> force;
  force.push = PushForceAt(scene, person, frame).template cast<T>();
  const ActiveForces active = ForcesAt(scene, options.push, person, frame);
  if (active == ActiveForces::kPushOnly) return force;
  force.friction = self.Friction(p, state.qd);
  if (active == ActiveForces::kPushAndFriction) return force;
  // Only here: a push that is the whole force includes the tail of an earlier one.
  if (options.push_tail == PushTail::kExponential) {
    for (const ScenePush& push : scene.pushes) {
      if (push.person == person) force.tail += TailForce(push, p, frame, scene.dt);
    }
  }
  force.balance = self.Balance(p, state, qd_previous);
  force.linear = self.Linear(p, state);
  force.interaction = interaction;
  return force;
}

// States of everybody at frames 0 .. num_frames - 1.
template <typename T>
class RolloutPath {
 public:
  RolloutPath() = default;
  RolloutPath(int num_frames, int num_people)
      : num_people_(num_people), states_(static_cast<size_t>(num_frames) * num_people) {}
  PendulumState<T>& At(int frame, int person) { return states_[Index(frame, person)]; }
  const PendulumState<T>& At(int frame, int person) const { return states_[Index(frame, person)]; }
  int num_people() const { return num_people_; }
  int num_frames() const {
    return num_people_ == 0 ? 0 : static_cast<int>(states_.size()) / num_people_;
  }

 private:
  size_t Index(int frame, int person) const {
    return static_cast<size_t>(frame) * num_people_ + person;
  }
  int num_people_ = 0;
  std::vector<PendulumState<T>> states_;
};

// Real part, whatever the scalar.
inline double RealPart(double value) { return value; }
template <typename Jet>
double RealPart(const Jet& value) {
  return value.a;
}

// Quantity that has left the domain, or an empty name.
template <typename T>
std::string_view OutsideDomain(const PendulumState<T>& state) {
  double sum = 0.0;
  for (int i = 0; i < 4; ++i) sum += RealPart(state.q[i]) + RealPart(state.qd[i]);
  if (!std::isfinite(sum)) return "state";
  if (std::abs(RealPart(state.q[2])) > kMaxAngle) return "theta";
  if (std::abs(RealPart(state.q[3])) > kMaxAngle) return "phi";
  return {};
}

// The self force of everybody in a scene.
std::vector<SelfForce> SelfForces(const Scene& scene, const ModelOptions& options);

// Two people of a scene as a contact sees them.
inline ContactPair PairOf(const Scene& scene, int n, int j) {
  const ScenePerson &a = scene.people[n], &b = scene.people[j];
  return {a.body, b.body, a.start.q, b.start.q};
}

// Whether the carts of two people are near enough to touch anywhere on their rods.
template <typename T>
bool MayTouch(const ContactPair& pair, const ParameterSet<T>& p, const PendulumState<T>& n,
              const PendulumState<T>& j) {
  // A rod leans its own length at the most.
  const double lean =
      RealPart(p[kContactHeight]) * (pair.body_n.rod_length + pair.body_j.rod_length);
  const double range = RealPart(p[kContactDistance]) + lean;
  return std::abs(RealPart(n.q[0]) - RealPart(j.q[0])) < range;
}

// What everybody gets from everybody else at one frame; zero without interaction. The parameters of
// a pair are those of the first person: contact is shared, never by subject.
template <typename T>
std::vector<Vector4<T>> InteractionForces(const Scene& scene, const ModelOptions& options,
                                          const std::vector<ParameterSet<T>>& parameters,
                                          const RolloutPath<T>& path, int frame) {
  std::vector<Vector4<T>> forces(scene.num_people(), Vector4<T>::Zero());
  if (options.interaction == Interaction::kNone) return forces;
  for (int n = 0; n < scene.num_people(); ++n) {
    for (int j = n + 1; j < scene.num_people(); ++j) {
      const ContactPair pair = PairOf(scene, n, j);
      const PendulumState<T>&a = path.At(frame, n), &b = path.At(frame, j);
      if (!MayTouch(pair, parameters[n], a, b)) continue;
      const ContactForce<T> force = ContactBetween(pair, parameters[n], a, b);
      forces[n] += force.on_n;
      forces[j] += force.on_j;
    }
  }
  return forces;
}

// parameters, initial_velocity: one entry per person. path is overwritten; on failure it holds the
// frames before the named one.
template <typename T>
RolloutStatus Rollout(const Scene& scene, const ModelOptions& options,
                      const std::vector<ParameterSet<T>>& parameters,
                      const std::vector<Vector4<T>>& initial_velocity, int num_frames,
                      RolloutPath<T>* path) {
  const std::vector<SelfForce> self = SelfForces(scene, options);
  *path = RolloutPath<T>(num_frames, scene.num_people());
  for (int n = 0; n < scene.num_people(); ++n) {
    path->At(0, n).q = scene.people[n].start.q.template cast<T>();
    path->At(0, n).qd = initial_velocity[n];
  }
  for (int t = 0; t + 1 < num_frames; ++t) {
    const std::vector<Vector4<T>> interaction =
        InteractionForces(scene, options, parameters, *path, t);
    for (int n = 0; n < scene.num_people(); ++n) {
      const PendulumState<T>& state = path->At(t, n);
      const Vector4<T>& previous = path->At(t > 0 ? t - 1 : 0, n).qd;
      const NetForce<T> force =
          NetForceAt(scene, options, self[n], parameters[n], n, t, state, previous, interaction[n]);
      const Vector4<T> qdd = Acceleration(scene.people[n].body, state, force.Total());
      path->At(t + 1, n) = Step(state, qdd, scene.dt);
      const std::string_view outside = OutsideDomain(path->At(t + 1, n));
      if (!outside.empty()) return {false, t + 1, n, outside};
    }
  }
  return {};
}

// The initial velocities that the scene itself holds.
std::vector<Vector4<double>> InitialVelocities(const Scene& scene);

}  // namespace pushid
