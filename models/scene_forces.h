// models: the net force on everybody in a scene, frame by frame.
//
//   F_net = the sum of the parts of terms.h, where by push kind (push.h)
//   and PushUse (options.h) a `net` push may replace all other forces, and a `net_without_friction`
//   push all but the friction, while it lasts. Where feet stand and step (stance.h), what a person
//   does about being pushed depends on the step state as well.
//
// Templated, so that the same lines serve doubles and automatic differentiation.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "models/interaction.h"
#include "models/learned_terms.h"
#include "models/neighbours.h"
#include "models/options.h"
#include "models/parameters.h"
#include "models/rod_law.h"
#include "models/scene.h"
#include "models/self_force.h"
#include "models/stance.h"

namespace pushid {

// Which forces act on a person during one step.
enum class ActiveForces { kAll, kPushAndFriction, kPushOnly };

ActiveForces ForcesAt(const Scene& scene, PushUse use, int person, int frame);

// The force of all pushes on a person in one step, without tails. Constant in the parameters.
Vector4<double> PushForceAt(const Scene& scene, int person, int frame);

// The parts of F_net on one person in one step (terms.h).
template <typename T>
struct NetForce {
  std::array<Vector4<T>, kNumForceParts> parts;
  Angles<T> angles;  // of the state at which it acts
  // Where feet stand and step: the ground's resistance (N s/m) to the cart's velocity after the
  // step, a part of the friction once that is known (AddGround), and the next step state.
  T ground = T(0.0), next_step = T(0.0);

  NetForce() { parts.fill(Vector4<T>::Zero()); }
  Vector4<T>& operator[](ForcePart part) { return parts[static_cast<int>(part)]; }
  const Vector4<T>& operator[](ForcePart part) const { return parts[static_cast<int>(part)]; }

  Vector4<T> Total() const {
    Vector4<T> sum = parts[0];
    for (int i = 1; i < kNumForceParts; ++i) sum += parts[i];
    return sum;
  }

  void AddGround(const Vector4<T>& next_qd) {
    for (int i = 0; i < 2; ++i) (*this)[ForcePart::kFriction][i] -= ground * next_qd[i];
  }
};

// The parts that reports list: all but for noise, and for a user's own laws where the model has
// none.
std::vector<ForcePart> ReportedParts(const ModelOptions& options);

// What a person gets from others, by part.
template <typename T>
struct Received {
  std::array<Vector4<T>, kNumPairParts> part;

  Received() { part.fill(Vector4<T>::Zero()); }
  Vector4<T> Now() const {
    Vector4<T> sum = part[0];
    for (int i = 1; i < kNumPairParts; ++i) sum += part[i];
    return sum;
  }
};

// What a person does about being pushed: friction, balance and the linear terms.
template <typename T>
void AddSlidingForces(const SelfForce& self, const ParameterSet<T>& p, ActiveForces active,
                      const PendulumState<T>& state, const Vector4<T>& qd_previous,
                      NetForce<T>* force) {
  if (active == ActiveForces::kPushOnly) return;
  (*force)[ForcePart::kFriction] = self.Friction(p, state.qd);
  if (active == ActiveForces::kPushAndFriction) return;
  (*force)[ForcePart::kBalance] = self.Balance(p, state, qd_previous);
  (*force)[ForcePart::kLinear] = self.Linear(p, state);
}

// The same of feet that stand and step.
template <typename T>
void AddStanceForces(const SelfForce& self, const ParameterSet<T>& p, ActiveForces active,
                     const PendulumState<T>& state, NetForce<T>* force) {
  using Cart = Eigen::Matrix<T, 2, 1>;
  const T &vx = state.qd[0], &vy = state.qd[1], &s = state.step;
  const Cart friction = self.Friction(p, state.qd).template head<2>();
  const Cart balance = self.Balance(p, state, state.qd).template head<2>();
  const Cart linear = self.LinearOnCart(p, state), cart_force = friction + balance + linear;
  const StanceParameters<T> stance([&p](Parameter id) { return p[id]; });
  const StanceForces<T> of_stance = StanceAt(self, stance, force->angles, state, cart_force);
  force->next_step = of_stance.next_step;
  if (active == ActiveForces::kPushOnly) return;
  Vector4<T>& ground = (*force)[ForcePart::kFriction];
  if (active == ActiveForces::kPushAndFriction) {
    ground = {-kPublishedFriction * vx, -kPublishedFriction * vy, T(0.0), T(0.0)};
    return;
  }
  force->ground = of_stance.ground;
  ground = {s * friction[0], s * friction[1], T(0.0), T(0.0)};
  (*force)[ForcePart::kBalance] = {s * balance[0], s * balance[1], of_stance.torque[0],
                                   of_stance.torque[1]};
  (*force)[ForcePart::kLinear] = {s * linear[0], s * linear[1], T(0.0), T(0.0)};
}

template <typename T>
NetForce<T> NetForceAt(const Scene& scene, const ModelOptions& options, const SelfForce& self,
                       const ParameterSet<T>& p, int person, int frame,
                       const PosedPendulum<T>& state, const Vector4<T>& qd_previous,
                       const Received<T>& received = {},
                       const Vector4<T>& network = Vector4<T>::Zero()) {
  NetForce<T> force;
  force.angles = state.angles;
  force[ForcePart::kPush] = PushForceAt(scene, person, frame).template cast<T>();
  const ActiveForces active = ForcesAt(scene, options.push, person, frame);
  const bool stands = options.stance == Stance::kThreshold;
  if (stands) {
    AddStanceForces(self, p, active, state, &force);
  } else {
    AddSlidingForces(self, p, active, state, qd_previous, &force);
  }
  if (active != ActiveForces::kAll) return force;
  // Only here: a push that is the whole force includes the tail of an earlier one.
  if (options.push_tail == PushTail::kExponential) {
    for (const ScenePush& push : scene.pushes) {
      if (push.person != person) continue;
      force[ForcePart::kTail] +=
          stands ? TailForceAtHip(push, p, self.body, force.angles, frame, scene.dt)
                 : TailForce(push, p, frame, scene.dt);
    }
  }
  if (!self.laws.empty()) force[ForcePart::kOwn] = self.Own(p, state);
  for (int i = 0; i < kNumPairParts; ++i) {
    force.parts[static_cast<int>(kFirstPairPart) + i] = received.part[i];
  }
  force[ForcePart::kNetwork] = network;
  return force;
}

// The self force of everybody in a scene.
std::vector<SelfForce> SelfForces(const Scene& scene, const ModelOptions& options);

// Everything a step needs besides the states, allocated once. Frame by frame: Update, Prepare for
// each person (PrepareAll asks every pair once), then On, AccelerationOf and Next, each person in
// any order and from any thread (each with a scratch of its own).
template <typename T>
class SceneForces {
 public:
  // parameters: one entry per person, or a single one for everybody. What two people share (the
  // pair parameters) is taken from the first. All arguments must outlive the object.
  // network_weights: of options.learned, all of them, instead of its own.
  SceneForces(const Scene& scene, const ModelOptions& options,
              const std::vector<ParameterSet<T>>& parameters, const T* network_weights = nullptr)
      : scene_(&scene),
        options_(&options),
        parameters_(&parameters),
        self_(SelfForces(scene, options)),
        finder_(scene, options.interaction),
        received_(scene.people.size()) {
    if (options.learned != nullptr) StartNetworks(network_weights);
  }

  // states: of everybody at the next frame, the first one at the first call.
  void Update(const PendulumState<T>* states) {
    states_.assign(states, states + scene_->people.size());
    finder_.Update(Parameters(0), states_);
  }

  // What all others do to one person, and what the person's own network answers: once a frame. Each
  // person adds up in canonical order (neighbours.h).
  void Prepare(int person, std::vector<int>* scratch) {
    finder_.Near(person, scratch);
    received_[person].part.fill(Vector4<T>::Zero());
    for (int other : *scratch) {
      const bool first = finder_.Rank(person) < finder_.Rank(other);
      const PairForces<T> forces = first ? Between(person, other) : Between(other, person);
      Receive(person, forces, first);
    }
    AskNetwork(person);
  }

  // The same for everybody, to the last bit.
  void PrepareAll() {
    for (Received<T>& received : received_) received.part.fill(Vector4<T>::Zero());
    acting_.clear();
    finder_.ForEachPair([this](int n, int j) {
      const PairForces<T> forces = Between(n, j);
      if (!forces.acts()) return;
      acting_.emplace_back(n, j);
      Receive(n, forces, true);
      Receive(j, forces, false);
    });
    for (int n = 0; n < scene_->num_people(); ++n) AskNetwork(n);
  }

  // The parts of the net force; qd_previous: the velocity one frame earlier.
  NetForce<T> On(int person, int frame, const Vector4<T>& qd_previous) const {
    return NetForceAt(*scene_, *options_, self_[person], Parameters(person), person, frame,
                      states_[person], qd_previous, received_[person],
                      networks_.empty() ? Vector4<T>(Vector4<T>::Zero()) : networks_[person].force);
  }

  Vector4<T> AccelerationOf(int person, const NetForce<T>& force) const {
    const Body& body = self_[person].body;
    const PendulumState<T>& state = states_[person];
    if (options_->stance == Stance::kThreshold) {
      return AccelerationOnGround(body, force.angles, state.qd, force.Total(), force.ground,
                                  scene_->dt);
    }
    const Vector4<T> total = force.Total();
    if (rods_.empty()) return Acceleration(body, force.angles, state.qd, total);
    return Acceleration(BodyNow(body, state.rod, T(0.0)), force.angles, state.qd, total);
  }

  // One step on: the pendulum under qdd, the step state and, where the model has a law for it, the
  // rod.
  PendulumState<T> Next(int person, const Vector4<T>& qdd, const NetForce<T>& force,
                        const Vector4<T>& qd_previous) {
    PendulumState<T> next = Step(states_[person], qdd, scene_->dt);
    next.step = force.next_step;
    if (!rods_.empty()) next.rod += scene_->dt * RodVelocityOf(person, qd_previous);
    return next;
  }

  const ParameterSet<T>& Parameters(int person) const {
    return (*parameters_)[parameters_->size() == 1 ? 0 : person];
  }
  // As Update left it.
  const PosedPendulum<T>& state(int person) const { return states_[person]; }
  // Who acted on whom at PrepareAll, as ForEachPair visits them.
  const std::vector<std::pair<int, int>>& acting() const { return acting_; }
  const SelfForce& self(int person) const { return self_[person]; }
  const Received<T>& received(int person) const { return received_[person]; }
  // As Prepare left it; only where options have a network.
  const NetworkState<T>& network(int person) const { return networks_[person].state; }
  // As Next left it; only where options have a law for the rod.
  const RodLayers<T>& rod(int person) const { return rods_[person]; }
  const PairFinder& pairs() const { return finder_; }

 private:
  struct Network {
    NetworkState<T> state;
    Vector4<T> force;
  };

  PairForces<T> Between(int n, int j) const {
    const Pair pair = finder_.Of(n, j);
    PairForces<T> forces =
        PairForcesBetween(options_->interaction, options_->interaction_network.get(), pair,
                          Parameters(0), states_[n], states_[j]);
    if (options_->interaction.learned) {
      const LearnedTerms& learned = *options_->learned;
      AddLearnedPair(learned.pair, network_weights_ + learned.pair_at(), pair, Parameters(0),
                     states_[n], states_[j], &forces.part[0]);
    }
    return forces;
  }

  // first: whether the person is the first of the two.
  void Receive(int person, const PairForces<T>& forces, bool first) {
    for (int i = 0; i < kNumPairParts; ++i) {
      const PairForce<T>& part = forces.part[i];
      if (part.acts) received_[person].part[i] += first ? part.on_n : part.on_j;
    }
  }

  void AskNetwork(int person) {
    if (networks_.empty()) return;
    const PendulumState<T>& state = states_[person];
    const SelfForce& self = self_[person];
    SetNetworkInputs<T>(state.q[2] - self.posture[0], state.q[3] - self.posture[1], state.qd,
                        &networks_[person].state);
    networks_[person].force = StepNetwork(options_->learned->shape, network_weights_,
                                          self.body.mass, &networks_[person].state);
  }

  void StartNetworks(const T* weights) {
    const LearnedTerms& network = *options_->learned;
    if (weights == nullptr) {
      for (double weight : network.weights) own_weights_.push_back(T(weight));
    }
    network_weights_ = weights != nullptr ? weights : own_weights_.data();
    for (const SelfForce& self : self_) {
      if (network.shape.any()) {
        networks_.push_back({NetworkState<T>(network.shape, self.body), Vector4<T>::Zero()});
      }
      if (network.rod.moves()) rods_.emplace_back(network.rod);
    }
  }

  // dl/dt of a person, m/s.
  T RodVelocityOf(int person, const Vector4<T>& qd_previous) {
    const SelfForce& self = self_[person];
    const PendulumState<T>& state = states_[person];
    const LearnedTerms& network = *options_->learned;
    Vector4<T> force = self.Total(Parameters(person), state, qd_previous);
    if (!networks_.empty()) force += networks_[person].force;
    for (int i = 0; i < 2; ++i) force[2 + i] -= self.hold[i];
    SetRodInputs<T>(state.q[2] - self.posture[0], state.q[3] - self.posture[1], state.qd, force,
                    state.rod, self.body.mass, &rods_[person]);
    return RodVelocity(network.rod, network_weights_ + network.rod_at(), &rods_[person]);
  }

  const Scene* scene_;
  const ModelOptions* options_;
  const std::vector<ParameterSet<T>>* parameters_;
  std::vector<SelfForce> self_;
  PairFinder finder_;
  std::vector<Received<T>> received_;
  std::vector<Network> networks_;
  std::vector<RodLayers<T>> rods_;
  std::vector<T> own_weights_;
  const T* network_weights_ = nullptr;
  std::vector<PosedPendulum<T>> states_;
  std::vector<std::pair<int, int>> acting_;
};

}  // namespace pushid
