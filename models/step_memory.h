// models: what a step of the model (step.h) needs besides the states and parameters of the people
// themselves: who acts on whom, what is learned with its memory, what late control perceives.
// Allocated once and used again frame by frame.
#pragma once

#include <vector>

#include "models/learned_terms.h"
#include "models/neighbours.h"
#include "models/net_force.h"
#include "models/reaction_delay.h"

namespace pushid {

template <typename T>
class StepMemory {
 public:
  // parameters: one entry per person, or a single one for everybody. What two people share (the
  // pair parameters) is taken from the first. All arguments must outlive the object.
  // network_weights: of options.learned, all of them, instead of its own.
  StepMemory(const Scene& scene, const ModelOptions& options,
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
  // Updates from a path that is known up to this frame.
  void Update(const RolloutPath<T>& path, int frame) {
    Update(path.Frame(frame));
    perceived_.clear();
    for (int n = 0; n < static_cast<int>(delayed_.size()); ++n) {
      perceived_.push_back(Perceive<T>(delayed_[n], Parameters(n), path, frame, n));
    }
  }

  // Forces of all others on one person, and of the person's own network: once a frame. Each
  // person adds up in canonical order (neighbours.h).
  void Prepare(int person, std::vector<int>* scratch) {
    finder_.Near(person, scratch);
    received_[person].setZero();
    for (int other : *scratch) {
      const bool first = finder_.Rank(person) < finder_.Rank(other);
      const PairForce<T> force = first ? Between(person, other) : Between(other, person);
      if (force.acts) received_[person] += first ? force.on_n : force.on_j;
    }
    AskNetwork(person);
  }

  // Prepares everybody, with the same bits.
  void PrepareAll() {
    for (Vector4<T>& received : received_) received.setZero();
    finder_.ForEachPair([this](int n, int j) {
      const PairForce<T> force = Between(n, j);
      if (!force.acts) return;
      received_[n] += force.on_n;
      received_[j] += force.on_j;
    });
    for (int n = 0; n < scene_->num_people(); ++n) AskNetwork(n);
  }

  const ParameterSet<T>& Parameters(int person) const {
    return (*parameters_)[parameters_->size() == 1 ? 0 : person];
  }
  // The state that Update posed.
  const PosedPendulum<T>& state(int person) const { return states_[person]; }
  // Null without a delay.
  const Perceived<T>* perceived(int person) const {
    return perceived_.empty() ? nullptr : &perceived_[person];
  }
  const SelfForce& self(int person) const { return self_[person]; }
  // The forces that Prepare found.
  const Vector4<T>& received(int person) const { return received_[person]; }
  Vector4<T> network(int person) const {
    return networks_.empty() ? Vector4<T>(Vector4<T>::Zero()) : networks_[person].force;
  }
  bool rod_moves() const { return RodMoves(*options_); }

  // dl/dt of a person whose rod moves, m/s.
  T RodVelocityOf(int person, const Vector4<T>& qd_previous) {
    const SelfForce& self = self_[person];
    const PendulumState<T>& state = states_[person];
    const LearnedTerms& learned = *options_->learned;
    Vector4<T> force = self.Effort(Parameters(person), state, qd_previous);
    if (!networks_.empty()) force += networks_[person].force;
    for (int i = 0; i < 2; ++i) force[2 + i] -= self.hold[i];
    const VectorX<T> inputs =
        RodInputs<T>(state.q[2] - self.posture[0], state.q[3] - self.posture[1], state.qd, force,
                     state.rod, self.body);
    return RodVelocity(learned.rod, network_weights_ + learned.rod_at(), inputs);
  }

 protected:
  const Scene* scene_;
  const ModelOptions* options_;

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

  void AskNetwork(int person) {
    if (networks_.empty()) return;
    const PendulumState<T>& state = states_[person];
    const SelfForce& self = self_[person];
    SetMotionInputs<T>(state.q[2] - self.posture[0], state.q[3] - self.posture[1], state.qd,
                       &networks_[person].state.inputs);
    networks_[person].force =
        StepNetwork(options_->learned->shape, network_weights_, &networks_[person].state);
  }

  void StartNetworks(const T* weights) {
    const LearnedTerms& learned = *options_->learned;
    if (weights == nullptr) {
      for (double weight : learned.weights) own_weights_.push_back(T(weight));
    }
    network_weights_ = weights != nullptr ? weights : own_weights_.data();
    if (!learned.shape.any()) return;
    for (const SelfForce& self : self_) {
      networks_.push_back(
          {NetworkState<T>(learned.shape, network_weights_, self.body), Vector4<T>::Zero()});
    }
  }

  const std::vector<ParameterSet<T>>* parameters_;
  std::vector<SelfForce> self_;
  PairFinder finder_;
  std::vector<Vector4<T>> received_;
  std::vector<Network> networks_;
  std::vector<T> own_weights_;
  const T* network_weights_ = nullptr;
  std::vector<PosedPendulum<T>> states_;
  std::vector<DelayedPlaces<T>> delayed_;
  std::vector<Perceived<T>> perceived_;
};

}  // namespace pushid
