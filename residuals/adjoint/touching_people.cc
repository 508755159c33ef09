// residuals: people who touch, forwards and backwards.
#include <algorithm>

#include "models/learned_terms.h"
#include "residuals/adjoint/adjoint_batch.h"
#include "residuals/sensitivities/learned_pair_jacobian.h"

namespace pushid {
namespace {

using Matrix = Eigen::MatrixXd;

// Adds the adjoint of [state of n, state of j].
void AddToBoth(const Eigen::Matrix<double, 1, 16>& by_states, int n, int j, Matrix* by_state) {
  by_state->col(n) += by_states.head<8>().transpose();
  by_state->col(j) += by_states.tail<8>().transpose();
}

}  // namespace

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
  for (const Contact& contact : contacts_[step]) {
    if (contact.terms) TermsBack(contact, now, by_received, by_state, by_parameter);
    if (contact.learned()) GateBack(contact, now, by_received, by_state, by_parameter);
  }
  if (network_) NetworkBack(step, by_received, by_state);
}

void TouchingPeople::TermsBack(const Contact& c, const PeopleNow& now, const Matrix& by_received,
                               Matrix* by_state, ParameterSet<double>* by_parameter) const {
  const PairJacobian jacobian = ComputePairJacobian(
      options_.interaction, c.pair, now.parameters[c.first], now.states[c.n], now.states[c.j]);
  Eigen::Matrix<double, 1, 8> by_forces;
  by_forces << by_received.col(c.n).transpose(), by_received.col(c.j).transpose();
  AddToBoth(by_forces * jacobian.by_states, c.n, c.j, by_state);
  Eigen::Map<Eigen::Matrix<double, 1, kNumPairParameters>>(
      by_parameter->data() + kFirstPairParameter) += by_forces * jacobian.by_parameter;
}

void TouchingPeople::GateBack(const Contact& c, const PeopleNow& now, const Matrix& by_received,
                              Matrix* by_state, ParameterSet<double>* by_parameter) const {
  if (options_.learned->pair.ldp) return;  // a hard switch
  const GateJacobian gate =
      PairGateJacobian(options_.learned->pair, c.pair, now.parameters[c.first], now.states[c.n].q,
                       now.states[c.j].q);
  const double by_gate =
      c.learned_n.dot(by_received.col(c.n)) + c.learned_j.dot(by_received.col(c.j));
  by_state->col(c.n).head<4>() += by_gate * gate.by_places.head<4>().transpose();
  by_state->col(c.j).head<4>() += by_gate * gate.by_places.tail<4>().transpose();
  Eigen::Map<Eigen::Matrix<double, 1, kContactParameters>>(
      by_parameter->data() + kContactStiffness) += by_gate * gate.by_parameter;
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
  const auto by_states = [this](int of) {
    const Eigen::Matrix<double, 1, PairShape::kInputs> by_input = inputs_.col(of).transpose();
    return PairInputsByStates(by_input);
  };
  for (const Contact& c : contacts) {
    if (!c.learned()) continue;
    AddToBoth(by_states(column++), c.n, c.j, by_state);
    AddToBoth(by_states(column++), c.j, c.n, by_state);
  }
}

void TouchingPeople::AddWeightGradient(double* gradient) {
  if (network_) network_->AddWeightGradient(gradient + options_.learned->pair_at());
}

}  // namespace pushid
