// models: the net force on everybody in a scene, frame by frame (net_force.h), with what people do
// to each other and what networks answer.
#pragma once

#include <vector>

#include "models/interaction.h"
#include "models/learned_terms.h"
#include "models/neighbours.h"
#include "models/net_force.h"

namespace pushid {

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
        received_(scene.people.size(), Vector4<T>::Zero()) {
    if (options.learned != nullptr) StartNetworks(network_weights);
    if (options.delay == Delay::kNone) return;
    for (int n = 0; n < scene.num_people(); ++n) {
      delayed_.emplace_back(options.delay, Parameters(n), scene.dt);
    }
  }

  // states: of everybody at the next frame, the first one at the first call. Of a model without a
  // delay.
  void Update(const PendulumState<T>* states) {
    states_.assign(states, states + scene_->people.size());
    finder_.Update(Parameters(0), states_);
  }
  // As above, from a path that is known up to this frame.
  void Update(const RolloutPath<T>& path, int frame) {
    Update(path.Frame(frame));
    perceived_.clear();
    for (int n = 0; n < static_cast<int>(delayed_.size()); ++n) {
      perceived_.push_back(Perceive<T>(delayed_[n], Parameters(n), path, frame, n));
    }
  }

  // What all others do to one person, and what the person's own network answers: once a frame. Each
  // person adds up in canonical order (neighbours.h).
  void Prepare(int person, std::vector<int>* scratch) {
    finder_.Near(person, scratch);
    received_[person].setZero();
    for (int other : *scratch) {
      const bool first = finder_.Rank(person) < finder_.Rank(other);
      const PairForce<T> force = first ? Between(person, other) : Between(other, person);
      Receive(person, force, first);
    }
    AskNetwork(person);
  }

  // Prepares everybody, with the same bits.
  void PrepareAll() {
    for (Vector4<T>& received : received_) received.setZero();
    finder_.ForEachPair([this](int n, int j) {
      const PairForce<T> force = Between(n, j);
      if (!force.acts) return;
      Receive(n, force, true);
      Receive(j, force, false);
    });
    for (int n = 0; n < scene_->num_people(); ++n) AskNetwork(n);
  }

  // The parts of the net force; qd_previous: the velocity one frame earlier.
  NetForce<T> On(int person, int frame, const Vector4<T>& qd_previous) const {
    return NetForceAt(*scene_, *options_, self_[person], Parameters(person), person, frame,
                      states_[person], qd_previous, received_[person],
                      networks_.empty() ? Vector4<T>(Vector4<T>::Zero()) : networks_[person].force,
                      perceived(person));
  }

  Vector4<T> AccelerationOf(int person, const NetForce<T>& force) const {
    const Body& body = self_[person].body;
    const PendulumState<T>& state = states_[person];
    if (HoldsFast(force)) {
      return AccelerationOnGround(StandingBody<T>(body, Parameters(person)[kComHeight]),
                                  force.angles, state.qd, force.Total(), force.ground,
                                  force.feet_velocity, scene_->dt);
    }
    if (options_->stance == Stance::kSteps) {
      return AccelerationOnGround(body, force.angles, state.qd, force.Total(), force.ground,
                                  force.feet_velocity, scene_->dt);
    }
    const Vector4<T> total = force.Total();
    if (options_->body == BodyModel::kTable) {
      return Acceleration(TableBody(body, Parameters(person)), force.angles, state.qd, total);
    }
    if (rods_.empty()) return Acceleration(body, force.angles, state.qd, total);
    return Acceleration(BodyNow(body, state.rod, T(0.0)), force.angles, state.qd, total);
  }

  // Whether the person is a body that turns about its ankles in this step (standing.h).
  bool HoldsFast(const NetForce<T>& force) const {
    return options_->stance == Stance::kFixed && RealPart(force.ground) > 0.0;
  }

  // One step on: the pendulum under qdd, the feet and, where the model has a law for it, the rod.
  PendulumState<T> Next(int person, const Vector4<T>& qdd, const NetForce<T>& force,
                        const Vector4<T>& qd_previous) {
    PendulumState<T> next = Step(states_[person], qdd, scene_->dt);
    if (options_->stance == Stance::kSteps) next.feet = force.next_feet;
    if (!rods_.empty()) next.rod += scene_->dt * RodVelocityOf(person, qd_previous);
    return next;
  }

  const ParameterSet<T>& Parameters(int person) const {
    return (*parameters_)[parameters_->size() == 1 ? 0 : person];
  }
  // As Update left it.
  const PosedPendulum<T>& state(int person) const { return states_[person]; }
  // Null without a delay.
  const Perceived<T>* perceived(int person) const {
    return perceived_.empty() ? nullptr : &perceived_[person];
  }
  const SelfForce& self(int person) const { return self_[person]; }
  const Vector4<T>& received(int person) const { return received_[person]; }
  // As Next left it; only where options have a law for the rod.
  const RodLayers<T>& rod(int person) const { return rods_[person]; }
  const PairFinder& pairs() const { return finder_; }

 private:
  struct Network {
    NetworkState<T> state;
    Vector4<T> force;
  };

  PairForce<T> Between(int n, int j) const {
    const Pair pair = finder_.Of(n, j);
    PairForce<T> force =
        InteractionBetween<T>(options_->interaction, pair, Parameters(0), states_[n], states_[j]);
    if (options_->interaction.learned) {
      const LearnedTerms& learned = *options_->learned;
      AddLearnedPair(learned.pair, network_weights_ + learned.pair_at(), pair, Parameters(0),
                     states_[n], states_[j], &force);
    }
    return force;
  }

  // first: whether the person is the first of the two.
  void Receive(int person, const PairForce<T>& force, bool first) {
    if (force.acts) received_[person] += first ? force.on_n : force.on_j;
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
    Vector4<T> force = self.Effort(Parameters(person), state, qd_previous);
    if (!networks_.empty()) force += networks_[person].force;
    for (int i = 0; i < 2; ++i) force[2 + i] -= self.hold[i];
    SetRodInputs<T>(state.q[2] - self.posture[0], state.q[3] - self.posture[1], state.qd, force,
                    state.rod, self.body, &rods_[person]);
    return RodVelocity(network.rod, network_weights_ + network.rod_at(), &rods_[person]);
  }

  const Scene* scene_;
  const ModelOptions* options_;
  const std::vector<ParameterSet<T>>* parameters_;
  std::vector<SelfForce> self_;
  PairFinder finder_;
  std::vector<Vector4<T>> received_;
  std::vector<Network> networks_;
  std::vector<RodLayers<T>> rods_;
  std::vector<T> own_weights_;
  const T* network_weights_ = nullptr;
  std::vector<PosedPendulum<T>> states_;
  std::vector<DelayedPlaces<T>> delayed_;
  std::vector<Perceived<T>> perceived_;
};

}  // namespace pushid
