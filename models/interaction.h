// models: the sum of the interaction terms a model asks for, between two people.
#pragma once

#include "models/contact.h"
#include "models/ldp_interaction.h"
#include "models/network_interaction.h"
#include "models/options.h"
#include "models/pair.h"

namespace pushid {

// Calls visit(term) for every term of the model that acts between two people.
template <typename Visit>
void ForEachTerm(const InteractionTerms& terms, const InteractionNetwork* network, Visit&& visit) {
  if (terms.spring && terms.damping) {
    visit(ContactTerm<true, true>{});
  } else if (terms.spring) {
    visit(ContactTerm<true, false>{});
  } else if (terms.damping) {
    visit(ContactTerm<false, true>{});
  }
  if (terms.potential) visit(PotentialTerm{});
  if (terms.lean) visit(LeanTerm{});
  if (terms.ldp_discrete) visit(LdpDiscreteTerm{});
  if (terms.network && network != nullptr) visit(NetworkTerm{network});
}

template <typename T>
PairForce<T> InteractionBetween(const InteractionTerms& terms, const InteractionNetwork* network,
                                const Pair& pair, const ParameterSet<T>& p,
                                const PendulumState<T>& n, const PendulumState<T>& j) {
  PairForce<T> force;
  ForEachTerm(terms, network, [&](auto term) { term.Add(pair, p, n, j, &force); });
  return force;
}

}  // namespace pushid
