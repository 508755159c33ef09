// residuals: people of several recordings rolled out side by side, and back.
#include "residuals/adjoint/adjoint_gradient.h"

#include <Eigen/Core>
#include <algorithm>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "models/learned_terms.h"
#include "models/neighbours.h"
#include "models/rollout.h"
#include "residuals/adjoint/batched_networks.h"
#include "residuals/adjoint/step_adjoint.h"

namespace pushid {
namespace {

using Eigen::MatrixXd;

// More people side by side are no faster, and each keeps all its steps.
constexpr int kPeopleTogether = 64;

MaybeError WhatCannotBeDone(const std::vector<AdjointRecording>& recordings,
                            const ModelOptions& options, const ParameterMap& map) {
  if (options.learned == nullptr) return Error{"the adjoint gradient needs a network"};
  if (options.stance != Stance::kSlide) {
    return Error{
        "the adjoint gradient is for feet that slide; leave --stance out, or use a "
        "network small enough for Gauss-Newton"};
  }
  if (map.num_deviations > 0) {
    return Error{
        "the adjoint gradient has no deviations by subject or setting; fit them without the "
        "network first and hold them here"};
  }
  for (const AdjointRecording& r : recordings) {
    const size_t people = static_cast<size_t>(r.recording->num_people());
    if (r.held.size() > 1 && r.held.size() != people) {
      return Error{"recording '" + r.recording->id + "' has " + std::to_string(people) +
                   " people, but held values of " + std::to_string(r.held.size())};
    }
    if (r.recording->initial_velocity == InitialVelocity::kFree) {
      return Error{"recording '" + r.recording->id +
                   "' has a free initial velocity, which the adjoint gradient does not fit; make "
                   "it zero or estimated"};
    }
  }
  return {};
}

int Frames(const AdjointRecording& r) {
  const int frames = r.recording->num_frames();
  return r.horizon > 0 ? std::min(r.horizon, frames) : frames;
}

// In place of the map's values, if any.
std::optional<ParameterSet<double>> Held(const AdjointRecording& r, int person) {
  if (r.held.empty()) return std::nullopt;
  return r.held[r.held.size() == 1 ? 0 : person];
}

BatchColumns ColumnsOf(const std::vector<AdjointRecording>& all,
                       const std::vector<int>& recordings) {
  std::vector<int> steps;
  for (int index : recordings) {
    steps.insert(steps.end(), all[index].recording->num_people(),
                 std::max(0, Frames(all[index]) - 1));
  }
  return BatchColumns(steps);
}

// Forces between people of several recordings, step by step, and back.
//
// With f the adjoint of what each of two people gets from the other, F = F_terms + 2 M g y of both,
//   L_s <- L_s + (dF_terms/ds)' f + (dg/ds)' (2 M y . f) + (du/ds)' u^,   s: the states of both
//   L_p <- L_p + (dF_terms/dp)' f + (dg/dp)' (2 M y . f)
// where u^ comes back through the network from y^ = 2 M g f (batched_networks.h). A person's step
// so hands parts to the neighbours' states. Terms and gate: PairBack (step_adjoint.h).
//
// Everybody is a column: the people of one recording side by side, one recording after the other.

// Everybody's state and parameters at one step, by column.
struct PeopleNow {
  std::vector<PendulumState<double>> states;
  std::vector<ParameterSet<double>> parameters;
};

class TouchingPeople {
 public:
  // options and scenes must outlive the object; scenes: of the recordings, in the columns' order.
  TouchingPeople(const ModelOptions& options, const std::vector<const Scene*>& scenes)
      : options_(options) {
    int first = 0;
    for (const Scene* scene : scenes) {
      groups_.push_back({scene, first, PairFinder(*scene, options.interaction)});
      first += scene->num_people();
    }
    if (!options.interaction.learned) return;
    const PairShape& shape = options.learned->pair;
    network_.emplace(PairShape::kInputs, shape.hidden, 4, shape.ldp);
  }

  // Before the first step; weights: of all that is learned, there until the last step back; null
  // where nothing is.
  void Start(const double* weights) {
    contacts_.clear();
    if (network_) network_->Start(weights + options_.learned->pair_at());
  }

  // The next step. going: by recording; who is not, is not looked at. received: 4 x columns, what
  // each gets from all others; overwritten.
  void Forward(const PeopleNow& now, const std::vector<bool>& going, MatrixXd* received) {
    std::vector<Contact>& contacts = contacts_.emplace_back();
    received->setZero(4, static_cast<Eigen::Index>(now.states.size()));
    for (size_t i = 0; i < groups_.size(); ++i) {
      if (going[i]) FindContacts(&groups_[i], now, &contacts, received);
    }
    if (network_) AskNetwork(now, &contacts, received);
  }

  // From the last step to the first, with the same states. by_received: d(cost)/d(received), 4 x
  // columns, zero for who is not going any more. Adds to by_state (8 x columns, [q, qd]) and to
  // by_parameter.
  void Backward(int step, const PeopleNow& now, const MatrixXd& by_received, MatrixXd* by_state,
                ParameterSet<double>* by_parameter) {
    if (network_) NetworkBack(step, by_received);
    int column = 0;
    for (const Contact& c : contacts_[step]) {
      const Vector4<double> by_n = by_received.col(c.n), by_j = by_received.col(c.j);
      const double by_gate = c.learned_n.dot(by_n) + c.learned_j.dot(by_j);
      const bool gated = c.learned() && !options_.learned->pair.ldp;  // LDP's is a hard switch
      const int asked = c.learned() ? 2 : 0;
      const MatrixXd by_inputs = inputs_.middleCols(column, asked);
      column += asked;
      const PairAdjoint by_states =
          PairBack(options_, c.pair, now.parameters[c.first], now.states[c.n], now.states[c.j],
                   by_n, by_j, gated ? &by_gate : nullptr, by_inputs, by_parameter);
      by_state->col(c.n) += by_states.head<8>();
      by_state->col(c.j) += by_states.tail<8>();
    }
  }

  // After the last of these: adds d(cost)/d(weights), of all that is learned.
  void AddWeightGradient(double* gradient) {
    if (network_) network_->AddWeightGradient(gradient + options_.learned->pair_at());
  }

 private:
  struct Group {
    const Scene* scene;
    int first;  // column
    PairFinder finder;
  };
  // Two people who act on each other at one step.
  struct Contact {
    int n, j, first;  // columns: of the two, of the first of their recording
    Pair pair;
    bool terms;   // whether any but the network acts
    double gate;  // of the network; 0: it does not act
    // 2 M y of both.
    Vector4<double> learned_n = Vector4<double>::Zero(), learned_j = Vector4<double>::Zero();

    bool learned() const { return gate > 0.0; }
  };

  void FindContacts(Group* group, const PeopleNow& now, std::vector<Contact>* contacts,
                    MatrixXd* received) const {
    const int first = group->first;
    const ParameterSet<double>& p = now.parameters[first];
    const auto* begin = &now.states[first];
    const std::vector<PosedPendulum<double>> states(begin, begin + group->scene->num_people());
    group->finder.Update(p, states);
    group->finder.ForEachPair([&](int n, int j) {
      Contact contact{first + n, first + j, first, group->finder.Of(n, j), false, 0.0};
      const PairForce<double> force =
          InteractionBetween<double>(options_.interaction, contact.pair, p, states[n], states[j]);
      contact.terms = force.acts;
      if (network_) {
        contact.gate =
            PairGate<double>(options_.learned->pair, contact.pair, p, states[n].q, states[j].q);
      }
      if (!contact.terms && !contact.learned()) return;
      received->col(contact.n) += force.on_n;
      received->col(contact.j) += force.on_j;
      contacts->push_back(contact);
    });
  }

  void AskNetwork(const PeopleNow& now, std::vector<Contact>* contacts, MatrixXd* received) {
    const auto asked = std::count_if(contacts->begin(), contacts->end(),
                                     [](const Contact& c) { return c.learned(); });
    inputs_.resize(PairShape::kInputs, 2 * asked);
    int column = 0;
    for (const Contact& c : *contacts) {
      if (!c.learned()) continue;
      const PendulumState<double>&n = now.states[c.n], &j = now.states[c.j];
      inputs_.col(column++) = PairInputs(n, j);
      inputs_.col(column++) = PairInputs(j, n);
    }
    network_->Forward(inputs_, &outputs_);
    const PairShape& shape = options_.learned->pair;
    column = 0;
    for (Contact& c : *contacts) {
      if (!c.learned()) continue;
      c.learned_n = shape.ForceUnit(c.pair.body_n) * outputs_.col(column++);
      c.learned_j = shape.ForceUnit(c.pair.body_j) * outputs_.col(column++);
      received->col(c.n) += c.gate * c.learned_n;
      received->col(c.j) += c.gate * c.learned_j;
    }
  }

  // To the adjoints of the network's inputs, in inputs_.
  void NetworkBack(int step, const MatrixXd& by_received) {
    const std::vector<Contact>& contacts = contacts_[step];
    const auto asked = std::count_if(contacts.begin(), contacts.end(),
                                     [](const Contact& c) { return c.learned(); });
    outputs_.resize(4, 2 * asked);
    const PairShape& shape = options_.learned->pair;
    int column = 0;
    for (const Contact& c : contacts) {
      if (!c.learned()) continue;
      outputs_.col(column++) = shape.ForceUnit(c.pair.body_n) * c.gate * by_received.col(c.n);
      outputs_.col(column++) = shape.ForceUnit(c.pair.body_j) * c.gate * by_received.col(c.j);
    }
    network_->Backward(step, outputs_, &inputs_);
  }

  const ModelOptions& options_;
  std::vector<Group> groups_;
  std::vector<std::vector<Contact>> contacts_;  // by step
  std::optional<BatchedLayers> network_;        // none: nothing is learned
  MatrixXd inputs_, outputs_;  // two columns for each contact that the network sees
};

}  // namespace

class AdjointGradient::Batch {
 public:
  // recordings: indices into `all`; those of more frames first.
  Batch(const std::vector<AdjointRecording>& all, const std::vector<int>& recordings,
        const ModelOptions& options, const ParameterMap& map, const ResidualSigmas& sigmas)
      : options_(options), sigmas_(sigmas), columns_(ColumnsOf(all, recordings)) {
    for (const ColumnEntry& entry : map.Entries(map.values)) acting_.push_back(entry.parameter);
    std::vector<double> masses;
    std::vector<const Scene*> scenes;
    for (int index : recordings) {
      const AdjointRecording& r = all[index];
      const std::vector<SelfForce> self = SelfForces(r.recording->scene, options);
      const int place = static_cast<int>(horizon_.size()), frames = Frames(r);
      horizon_.push_back(frames);
      scenes.push_back(&r.recording->scene);
      for (int n = 0; n < r.recording->num_people(); ++n) {
        walkers_.push_back({r.recording, index, place, n, r.weight, self[n], Held(r, n),
                            std::vector<PendulumState<double>>(frames),
                            std::vector<Vector4<double>>(frames)});
        if (frames > 0) walkers_.back().path[0] = r.recording->scene.people[n].start;
        masses.push_back(self[n].body.mass);
      }
    }
    const LearnedTerms& network = *options_.learned;
    if (network.shape.any()) network_.emplace(network.shape, columns_, masses);
    if (network.rod.moves()) rod_.emplace(RodShape::kInputs, network.rod.hidden, 1, true);
    if (options_.interaction.Any()) others_.emplace(options_, scenes);
    now_.states.resize(walkers_.size());
  }

  // Returns the cost, and what became of the batch's recordings.
  double Forward(const ParameterMap& map, const double* shared, const double* weights,
                 std::vector<RolloutStatus>* status) {
    end_ = horizon_;
    now_.parameters.clear();
    ParameterMap own = map;
    for (const Walker& walker : walkers_) {
      own.values = walker.held.value_or(map.values);
      now_.parameters.push_back(own.Apply<double>(shared, nullptr));
    }
    if (network_) network_->Start(weights);
    if (rod_) rod_->Start(weights + options_.learned->rod_at());
    if (others_) others_->Start(weights);
    for (int step = 0; step < columns_.num_steps(); ++step) {
      SetStates(step);
      SetForces(step);
      SetReceived(step);
      SetRodVelocities(step);
      Step(step, status);
    }
    return Cost();
  }

  // After Forward. by_parameter: of natural values, the sum over all people; adds to both.
  // by_weight may be null.
  void Backward(ParameterSet<double>* by_parameter, double* by_weight) {
    std::vector<StateAdjoint> adjoints(walkers_.size());  // of the frame after the step
    for (int step = columns_.num_steps() - 1; step >= 0; --step) {
      RodBack(step, &adjoints);
      const int people = columns_.active(step);
      forces_.setZero(4, people);
      received_.setZero(4, static_cast<Eigen::Index>(walkers_.size()));
      Eigen::VectorXd by_rod;
      ForEachGoing(step, [&](int column, Walker&) {
        if (rod_) by_rod = rod_inputs_.col(column);
        const ForceAdjoint by_force =
            StepBack(column, step, rod_ ? &by_rod : nullptr, &adjoints[column], by_parameter);
        forces_.col(column) = by_force.network;
        received_.col(column) = by_force.received;
      });
      ForcesBack(step, &adjoints, by_parameter);
    }
    if (by_weight == nullptr) return;
    if (network_) network_->AddWeightGradient(by_weight);
    if (rod_) rod_->AddWeightGradient(by_weight + options_.learned->rod_at());
    if (others_) others_->AddWeightGradient(by_weight);
  }

 private:
  // d(cost)/d(force) of what a step back does not know itself: of the own network's, and of what
  // others do.
  struct ForceAdjoint {
    Vector4<double> network = Vector4<double>::Zero(), received = Vector4<double>::Zero();
  };

  // One column of the batch.
  struct Walker {
    const PendulumRecording* recording;
    int index, place, person;  // of the recording among all, in the batch; of the person in it
    double weight;
    SelfForce self;
    std::optional<ParameterSet<double>> held;  // in place of the map's values
    std::vector<PendulumState<double>> path;
    std::vector<Vector4<double>> acceleration;

    const Scene& scene() const { return recording->scene; }
    const Body& body() const { return self.body; }
    const Vector4<double>& VelocityBefore(int frame) const {
      return path[frame > 0 ? frame - 1 : 0].qd;
    }
  };

  MeasuredFrame Measured(const Walker& walker, int frame) const {
    return MeasuredAt(*walker.recording, frame, walker.person, rod_.has_value());
  }
  // Calls visit(column, walker) for everybody who takes this step.
  template <typename Visit>
  void ForEachGoing(int step, const Visit& visit) {
    for (int column = 0; column < columns_.active(step); ++column) {
      if (step + 1 < end_[walkers_[column].place]) visit(column, walkers_[column]);
    }
  }
  const ParameterSet<double>& Parameters(int column) const { return now_.parameters[column]; }
  void SetStates(int step) {
    if (!others_) return;
    ForEachGoing(step, [&](int column, Walker& w) { now_.states[column] = w.path[step]; });
  }

  // Forces of the networks at the states of a step.
  void SetForces(int step) {
    const int people = columns_.active(step);
    forces_.setZero(4, people);
    if (!network_) return;
    VectorX<double> u(kMotionInputs);
    inputs_.setZero(kMotionInputs, people);
    ForEachGoing(step, [&](int column, Walker& walker) {
      const PendulumState<double>& state = walker.path[step];
      SetMotionInputs<double>(state.q[2] - walker.self.posture[0],
                              state.q[3] - walker.self.posture[1], state.qd, &u);
      inputs_.col(column) = u;
    });
    network_->Forward(step, inputs_, &forces_);
  }

  void SetReceived(int step) {
    if (!others_) return;
    std::vector<bool> going;
    for (int end : end_) going.push_back(step + 1 < end);
    others_->Forward(now_, going, &received_);
  }

  void SetRodVelocities(int step) {
    const int people = columns_.active(step);
    rod_velocities_.setZero(1, people);
    if (!rod_) return;
    rod_inputs_.setZero(RodShape::kInputs, people);
    ForEachGoing(step, [&](int column, Walker& walker) {
      const PendulumState<double>& state = walker.path[step];
      Vector4<double> force =
          walker.self.Effort(Parameters(column), state, walker.VelocityBefore(step));
      force += forces_.col(column);
      force.tail<2>() -= walker.self.hold;
      rod_inputs_.col(column) = RodInputs<double>(state.q[2] - walker.self.posture[0],
                                                  state.q[3] - walker.self.posture[1], state.qd,
                                                  force, state.rod, walker.body());
    });
    rod_->Forward(rod_inputs_, &rod_velocities_);
    rod_velocities_ *= kRodSpeed;
  }

  void Step(int step, std::vector<RolloutStatus>* status) {
    Vector4<double> received = Vector4<double>::Zero();
    ForEachGoing(step, [&](int column, Walker& walker) {
      const PendulumState<double>& state = walker.path[step];
      if (others_) received = received_.col(column);
      const Vector4<double> force =
          NetForceAt<double>(walker.scene(), options_, walker.self, Parameters(column),
                             walker.person, step, state, walker.VelocityBefore(step), received,
                             forces_.col(column))
              .Total();
      walker.acceleration[step] = Acceleration(BodyNow(walker.body(), state.rod), state, force);
      PendulumState<double>& next = walker.path[step + 1];
      next = pushid::Step(state, walker.acceleration[step], walker.scene().dt);
      next.rod += walker.scene().dt * rod_velocities_(0, column);
      const std::string_view outside = OutsideDomain(walker.body(), next);
      if (outside.empty()) return;
      (*status)[walker.index] = {false, step + 1, walker.person, outside};
      end_[walker.place] = step + 1;
      for (int other = 0; network_ && other < columns_.active(step); ++other) {
        if (walkers_[other].place == walker.place) network_->Forget(step, other);
      }
    });
  }

  double Cost() const {
    double cost = 0.0;
    for (size_t column = 0; column < walkers_.size(); ++column) {
      const Walker& walker = walkers_[column];
      for (int t = 1; t < end_[walker.place]; ++t) {
        const PendulumState<double>& state = walker.path[t];
        const FrameVector<double> r =
            walker.weight * FrameResidual<double>(BodyNow(walker.body(), state.rod), state,
                                                  Measured(walker, t), sigmas_);
        cost += 0.5 * r.squaredNorm();
      }
    }
    return cost;
  }

  // A walker's step back but for networks and others. by_rod: the adjoint of what the rod's law
  // saw; null where it is constant.
  ForceAdjoint StepBack(int column, int step, const Eigen::VectorXd* by_rod, StateAdjoint* adjoint,
                        ParameterSet<double>* by_parameter) const {
    const Walker& walker = walkers_[column];
    const PendulumState<double>& state = walker.path[step];
    const double dt = walker.scene().dt;
    const Vector4<double> g = adjoint->state.tail<4>() + dt * adjoint->state.head<4>();
    const Body body = BodyNow(walker.body(), state.rod);
    const Vector4<double> f =
        dt * (InverseMassMatrix(body, Angles<double>(state.q), body.mass) * g);
    adjoint->state.tail<4>() = g;
    // The share that the step after this one left for the velocity before it.
    adjoint->state.segment<2>(4) += adjoint->before;
    adjoint->before.setZero();
    Vector4<double> seen;
    if (by_rod != nullptr) {
      adjoint->rod += (*by_rod)[RodShape::kRodInput] / kNetworkRod;
      adjoint->state.tail<6>() += by_rod->head<6>().cwiseProduct(MotionInputScales());
      seen =
          by_rod->segment<4>(RodShape::kForceInputs) / (kNetworkAcceleration * walker.body().mass);
    }
    PersonBack({walker.scene(), options_, walker.self, Parameters(column), walker.person, step,
                state, walker.VelocityBefore(step)},
               walker.acceleration[step], f, by_rod != nullptr ? &seen : nullptr, acting_, adjoint,
               by_parameter);
    if (step == 0) {  // there the velocity before is that of the frame itself
      adjoint->state.segment<2>(4) += adjoint->before;
      adjoint->before.setZero();
    }
    ForceAdjoint by_force;
    if (ForcesAt(walker.scene(), options_.push, walker.person, step) == ActiveForces::kAll) {
      by_force = {f, f};
    }
    if (by_rod != nullptr) by_force.network += seen;
    return by_force;
  }

  // Adds the residuals of the frame after a step, and goes back through the rods' laws.
  void RodBack(int step, std::vector<StateAdjoint>* adjoints) {
    rod_velocities_.setZero(1, columns_.active(step));
    ForEachGoing(step, [&](int column, Walker& walker) {
      StateAdjoint& adjoint = (*adjoints)[column];
      FrameBack(walker.body(), walker.path[step + 1], Measured(walker, step + 1), sigmas_,
                walker.weight, &adjoint);
      rod_velocities_(0, column) = kRodSpeed * walker.scene().dt * adjoint.rod;
    });
    if (rod_) rod_->Backward(step, rod_velocities_, &rod_inputs_);
  }

  // From the adjoints of a step's forces, forces_ and received_, to those of its states.
  void ForcesBack(int step, std::vector<StateAdjoint>* adjoints,
                  ParameterSet<double>* by_parameter) {
    if (network_) {
      network_->Backward(step, forces_, &inputs_);
      for (int column = 0; column < columns_.active(step); ++column) {
        (*adjoints)[column].state.tail<6>() +=
            inputs_.col(column).head<6>().cwiseProduct(MotionInputScales());
      }
    }
    if (!others_) return;
    SetStates(step);
    by_state_.setZero(8, static_cast<Eigen::Index>(walkers_.size()));
    others_->Backward(step, now_, received_, &by_state_, by_parameter);
    for (size_t column = 0; column < walkers_.size(); ++column) {
      (*adjoints)[column].state += by_state_.col(static_cast<Eigen::Index>(column));
    }
  }

  const ModelOptions options_;
  const ResidualSigmas sigmas_;
  std::vector<Parameter> acting_;  // those that are fitted
  std::vector<Walker> walkers_;
  std::vector<int> horizon_, end_;  // by place: frames to roll out, and those that count
  BatchColumns columns_;
  std::optional<BatchedNetwork> network_;  // none: no force
  std::optional<BatchedLayers> rod_;       // none: constant
  std::optional<TouchingPeople> others_;   // none: nobody does anything to another
  PeopleNow now_;                          // states: only where people touch
  MatrixXd inputs_, forces_, rod_inputs_, rod_velocities_;
  MatrixXd received_, by_state_;  // from others; backwards the adjoints of both sides
};

int AdjointCost::num_failed() const {
  return static_cast<int>(
      std::count_if(status.begin(), status.end(), [](const RolloutStatus& s) { return !s.ok; }));
}

AdjointGradient::AdjointGradient() = default;
AdjointGradient::AdjointGradient(AdjointGradient&&) noexcept = default;
AdjointGradient::~AdjointGradient() = default;

Result<AdjointGradient> AdjointGradient::Create(const std::vector<AdjointRecording>& recordings,
                                                const ModelOptions& options,
                                                const ParameterMap& map,
                                                const ResidualSigmas& sigmas) {
  if (const MaybeError error = WhatCannotBeDone(recordings, options, map)) return *error;
  AdjointGradient gradient;
  gradient.map_ = map;
  gradient.num_weights_ = options.learned->num_weights();
  gradient.num_recordings_ = static_cast<int>(recordings.size());
  std::vector<int> order(recordings.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return Frames(recordings[a]) > Frames(recordings[b]); });
  for (size_t begin = 0; begin < order.size();) {
    std::vector<int> together;
    for (int people = 0; begin < order.size() && (together.empty() || people < kPeopleTogether);) {
      people += recordings[order[begin]].recording->num_people();
      together.push_back(order[begin++]);
    }
    gradient.batches_.push_back(
        std::make_unique<Batch>(recordings, together, options, map, sigmas));
  }
  return gradient;
}

int AdjointGradient::num_shared() const { return map_.num_shared(); }
int AdjointGradient::num_weights() const { return num_weights_; }

AdjointCost AdjointGradient::Evaluate(const double* shared, const double* weights,
                                      double* by_shared, double* by_weight) {
  ParameterSet<double> by_parameter{};
  AdjointCost result;
  result.status.resize(num_recordings_);
  if (by_weight != nullptr) std::fill_n(by_weight, num_weights_, 0.0);
  for (const auto& batch : batches_) {
    result.cost += batch->Forward(map_, shared, weights, &result.status);
    if (by_shared == nullptr && by_weight == nullptr) continue;
    batch->Backward(&by_parameter, by_weight);
  }
  if (by_shared == nullptr) return result;
  std::fill_n(by_shared, map_.num_shared(), 0.0);
  // Fitted values are everybody's, and so are the slopes.
  const ParameterSet<double> p = map_.Apply<double>(shared, nullptr);
  for (const ColumnEntry& entry : map_.Entries(p)) {
    by_shared[entry.column] += entry.derivative * by_parameter[entry.parameter];
  }
  return result;
}

}  // namespace pushid
