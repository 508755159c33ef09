// residuals: rollouts side by side, forth and back.
#include "residuals/adjoint/adjoint_batch.h"

#include <algorithm>

#include "models/learned_terms.h"
#include "residuals/adjoint/step_adjoint.h"

namespace pushid {
namespace {

int Frames(const AdjointRecording& r) {
  const int frames = r.recording->num_frames();
  return r.horizon > 0 ? std::min(r.horizon, frames) : frames;
}

// In place of the map's values, if any.
std::optional<ParameterSet<double>> Held(const AdjointRecording& r, int person) {
  if (r.held.empty()) return std::nullopt;
  return r.held[r.held.size() == 1 ? 0 : person];
}

PackedColumns ColumnsOf(const std::vector<AdjointRecording>& all,
                        const std::vector<int>& recordings) {
  std::vector<int> steps;
  for (int index : recordings) {
    steps.insert(steps.end(), all[index].recording->num_people(),
                 std::max(0, Frames(all[index]) - 1));
  }
  return PackedColumns(steps);
}

using Matrix = Eigen::MatrixXd;

// Adds the adjoint of [state of n, state of j].
void AddToBoth(const PairAdjoint& by_states, int n, int j, Matrix* by_state) {
  by_state->col(n) += by_states.head<8>();
  by_state->col(j) += by_states.tail<8>();
}

}  // namespace

MeasuredFrame AdjointGradient::Batch::Walker::Measured(int frame, bool rod_moves) const {
  return {recording->hip[person][frame], recording->states[person][frame],
          recording->Weight(person, frame), rod_moves ? recording->RodChange(person, frame) : 0.0};
}

AdjointGradient::Batch::Batch(const std::vector<AdjointRecording>& all,
                              const std::vector<int>& recordings, const ModelOptions& options,
                              const ResidualSigmas& sigmas, const VectorKernels& kernels)
    : options_(options), sigmas_(sigmas), columns_(ColumnsOf(all, recordings)) {
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
  if (network.shape.any()) network_.emplace(network.shape, kernels, columns_, masses);
  if (network.rod.moves()) rod_.emplace(network.rod, kernels);
  if (options_.interaction.Any()) others_.emplace(options_, scenes, kernels);
  now_.states.resize(walkers_.size());
}

double AdjointGradient::Batch::Forward(const ParameterMap& map, const double* shared,
                                       const double* weights, std::vector<RolloutStatus>* status) {
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

void AdjointGradient::Batch::SetStates(int step) {
  if (!others_) return;
  for (int column = 0; column < columns_.active(step); ++column) {
    const Walker& walker = walkers_[column];
    if (Going(walker, step)) now_.states[column] = walker.path[step];
  }
}

void AdjointGradient::Batch::SetReceived(int step) {
  if (!others_) return;
  std::vector<bool> going;
  for (int end : end_) going.push_back(step + 1 < end);
  others_->Forward(now_, going, &received_);
}

void AdjointGradient::Batch::SetForces(int step) {
  const int people = columns_.active(step);
  forces_.setZero(4, people);
  if (!network_) return;
  VectorX<double> u(kMotionInputs);
  inputs_.setZero(kMotionInputs, people);
  for (int column = 0; column < people; ++column) {
    const Walker& walker = walkers_[column];
    if (!Going(walker, step)) continue;
    const PendulumState<double>& state = walker.path[step];
    SetMotionInputs<double>(state.q[2] - walker.self.posture[0],
                            state.q[3] - walker.self.posture[1], state.qd, &u);
    inputs_.col(column) = u;
  }
  network_->Forward(step, inputs_, &forces_);
}

void AdjointGradient::Batch::SetRodVelocities(int step) {
  const int people = columns_.active(step);
  rod_velocities_.setZero(1, people);
  if (!rod_) return;
  RodLayers<double> layers(options_.learned->rod);
  rod_inputs_.setZero(options_.learned->rod.num_inputs(), people);
  for (int column = 0; column < people; ++column) {
    const Walker& walker = walkers_[column];
    if (!Going(walker, step)) continue;
    const PendulumState<double>& state = walker.path[step];
    Vector4<double> force =
        walker.self.Effort(Parameters(column), state, walker.VelocityBefore(step));
    force += forces_.col(column);
    force.tail<2>() -= walker.self.hold;
    SetRodInputs<double>(state.q[2] - walker.self.posture[0], state.q[3] - walker.self.posture[1],
                         state.qd, force, state.rod, walker.body(), &layers);
    rod_inputs_.col(column) = layers.inputs;
  }
  rod_->Forward(rod_inputs_, &rod_velocities_);
  rod_velocities_ *= kRodSpeed;
}

void AdjointGradient::Batch::Step(int step, std::vector<RolloutStatus>* status) {
  Vector4<double> received = Vector4<double>::Zero();
  for (int column = 0; column < columns_.active(step); ++column) {
    Walker& walker = walkers_[column];
    if (!Going(walker, step)) continue;
    const PendulumState<double>& state = walker.path[step];
    if (others_) received = received_.col(column);
    const Vector4<double> force =
        NetForceAt<double>(walker.scene(), options_, walker.self, Parameters(column), walker.person,
                           step, state, walker.VelocityBefore(step), received, forces_.col(column))
            .Total();
    walker.acceleration[step] = Acceleration(BodyNow(walker.body(), state.rod, 0.0), state, force);
    PendulumState<double>& next = walker.path[step + 1];
    next = pushid::Step(state, walker.acceleration[step], walker.scene().dt);
    next.rod += walker.scene().dt * rod_velocities_(0, column);
    const std::string_view outside = OutsideDomain(walker.body(), next);
    if (outside.empty()) continue;
    (*status)[walker.index] = {false, step + 1, walker.person, outside};
    end_[walker.place] = step + 1;
    if (!network_) continue;
    for (int other = 0; other < columns_.active(step); ++other) {
      if (walkers_[other].place == walker.place) network_->Forget(step, other);
    }
  }
}

double AdjointGradient::Batch::Cost() const {
  double cost = 0.0;
  for (size_t column = 0; column < walkers_.size(); ++column) {
    const Walker& walker = walkers_[column];
    const double lift = now_.parameters[column][kRodLift];
    for (int t = 1; t < end_[walker.place]; ++t) {
      const PendulumState<double>& state = walker.path[t];
      const FrameVector<double> r =
          walker.weight * FrameResidual<double>(BodyNow(walker.body(), state.rod, lift), state,
                                                walker.Measured(t, rod_.has_value()), sigmas_);
      cost += 0.5 * r.squaredNorm();
    }
  }
  return cost;
}

TouchingPeople::TouchingPeople(const ModelOptions& options, const std::vector<const Scene*>& scenes,
                               const VectorKernels& kernels)
    : options_(options) {
  int first = 0;
  for (const Scene* scene : scenes) {
    groups_.push_back({scene, first, PairFinder(*scene, options.interaction)});
    first += scene->num_people();
  }
  if (options.interaction.learned) network_.emplace(options.learned->pair, kernels);
}

void TouchingPeople::Start(const double* weights) {
  contacts_.clear();
  if (network_) network_->Start(weights + options_.learned->pair_at());
}

void TouchingPeople::Forward(const PeopleNow& now, const std::vector<bool>& going,
                             Matrix* received) {
  std::vector<Contact>& contacts = contacts_.emplace_back();
  received->setZero(4, static_cast<Eigen::Index>(now.states.size()));
  for (size_t i = 0; i < groups_.size(); ++i) {
    if (going[i]) FindContacts(&groups_[i], now, &contacts, received);
  }
  if (network_) AskNetwork(now, &contacts, received);
}

void TouchingPeople::FindContacts(Group* group, const PeopleNow& now,
                                  std::vector<Contact>* contacts, Matrix* received) const {
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

void TouchingPeople::AskNetwork(const PeopleNow& now, std::vector<Contact>* contacts,
                                Matrix* received) {
  const auto asked = std::count_if(contacts->begin(), contacts->end(),
                                   [](const Contact& c) { return c.learned(); });
  inputs_.resize(PairShape::kInputs, 2 * asked);
  VectorX<double> u;
  int column = 0;
  for (const Contact& c : *contacts) {
    if (!c.learned()) continue;
    for (const auto& [own, other] : {std::pair(c.n, c.j), std::pair(c.j, c.n)}) {
      SetPairInputs(now.states[own], now.states[other], &u);
      inputs_.col(column++) = u;
    }
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

void TouchingPeople::Backward(int step, const PeopleNow& now, const Matrix& by_received,
                              Matrix* by_state, ParameterSet<double>* by_parameter) {
  for (const Contact& c : contacts_[step]) {
    const Vector4<double> by_n = by_received.col(c.n), by_j = by_received.col(c.j);
    const double by_gate = c.learned_n.dot(by_n) + c.learned_j.dot(by_j);
    const bool gated = c.learned() && !options_.learned->pair.ldp;  // LDP's is a hard switch
    PairAdjoint by_states = PairAdjoint::Zero();
    PairBack(options_, c.pair, now.parameters[c.first], now.states[c.n], now.states[c.j], by_n,
             by_j, gated ? &by_gate : nullptr, &by_states, by_parameter);
    AddToBoth(by_states, c.n, c.j, by_state);
  }
  if (network_) NetworkBack(step, by_received, by_state);
}

void TouchingPeople::NetworkBack(int step, const Matrix& by_received, Matrix* by_state) {
  const std::vector<Contact>& contacts = contacts_[step];
  const auto asked =
      std::count_if(contacts.begin(), contacts.end(), [](const Contact& c) { return c.learned(); });
  outputs_.resize(4, 2 * asked);
  const PairShape& shape = options_.learned->pair;
  int column = 0;
  for (const Contact& c : contacts) {
    if (!c.learned()) continue;
    outputs_.col(column++) = shape.ForceUnit(c.pair.body_n) * c.gate * by_received.col(c.n);
    outputs_.col(column++) = shape.ForceUnit(c.pair.body_j) * c.gate * by_received.col(c.j);
  }
  network_->Backward(step, outputs_, &inputs_);
  column = 0;
  for (const Contact& c : contacts) {
    if (!c.learned()) continue;
    AddToBoth(PairInputsBack(inputs_.col(column++)), c.n, c.j, by_state);
    AddToBoth(PairInputsBack(inputs_.col(column++)), c.j, c.n, by_state);
  }
}

void TouchingPeople::AddWeightGradient(double* gradient) {
  if (network_) network_->AddWeightGradient(gradient + options_.learned->pair_at());
}

AdjointGradient::Batch::ForceAdjoint AdjointGradient::Batch::StepBack(
    int column, int step, const Eigen::VectorXd* by_rod, StateAdjoint* adjoint,
    ParameterSet<double>* by_parameter) const {
  const Walker& walker = walkers_[column];
  const PendulumState<double>& state = walker.path[step];
  const double dt = walker.scene().dt;
  const Vector4<double> g = adjoint->state.tail<4>() + dt * adjoint->state.head<4>();
  const Body body = BodyNow(walker.body(), state.rod, 0.0);
  const Vector4<double> f = dt * (InverseMassMatrix(body, state.q) * g);
  adjoint->state.tail<4>() = g;
  // What the step after this one left for the velocity before it.
  adjoint->state.segment<2>(4) += adjoint->before;
  adjoint->before.setZero();
  Vector4<double> seen;
  if (by_rod != nullptr) {
    adjoint->rod += (*by_rod)[RodShape::kRodInput] / kNetworkRod;
    adjoint->state.tail<6>() += by_rod->head<6>().cwiseProduct(MotionInputScales());
    seen = by_rod->segment<4>(RodShape::kForceInputs) / (kNetworkAcceleration * walker.body().mass);
  }
  PersonBack({walker.scene(), options_, walker.self, Parameters(column), walker.person, step, state,
              walker.VelocityBefore(step)},
             walker.acceleration[step], f, by_rod != nullptr ? &seen : nullptr, adjoint,
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

void AdjointGradient::Batch::Backward(ParameterSet<double>* by_parameter, double* by_weight) {
  std::vector<StateAdjoint> adjoints(walkers_.size());  // of the frame after the step
  for (int step = columns_.num_steps() - 1; step >= 0; --step) {
    RodBack(step, &adjoints, by_parameter);
    const int people = columns_.active(step);
    forces_.setZero(4, people);
    received_.setZero(4, static_cast<Eigen::Index>(walkers_.size()));
    Eigen::VectorXd by_rod;
    for (int column = 0; column < people; ++column) {
      if (!Going(walkers_[column], step)) continue;
      if (rod_) by_rod = rod_inputs_.col(column);
      const ForceAdjoint by_force =
          StepBack(column, step, rod_ ? &by_rod : nullptr, &adjoints[column], by_parameter);
      forces_.col(column) = by_force.network;
      received_.col(column) = by_force.received;
    }
    ForcesBack(step, &adjoints, by_parameter);
  }
  if (by_weight == nullptr) return;
  if (network_) network_->AddWeightGradient(by_weight);
  if (rod_) rod_->AddWeightGradient(by_weight + options_.learned->rod_at());
  if (others_) others_->AddWeightGradient(by_weight);
}

void AdjointGradient::Batch::RodBack(int step, std::vector<StateAdjoint>* adjoints,
                                     ParameterSet<double>* by_parameter) {
  const int people = columns_.active(step);
  rod_velocities_.setZero(1, people);
  for (int column = 0; column < people; ++column) {
    const Walker& walker = walkers_[column];
    if (!Going(walker, step)) continue;
    StateAdjoint& adjoint = (*adjoints)[column];
    (*by_parameter)[kRodLift] +=
        FrameBack(walker.body(), Parameters(column)[kRodLift], walker.path[step + 1],
                  walker.Measured(step + 1, rod_.has_value()), sigmas_, walker.weight, &adjoint);
    rod_velocities_(0, column) = kRodSpeed * walker.scene().dt * adjoint.rod;
  }
  if (rod_) rod_->Backward(step, rod_velocities_, &rod_inputs_);
}

void AdjointGradient::Batch::ForcesBack(int step, std::vector<StateAdjoint>* adjoints,
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

}  // namespace pushid
