// models: the sum of the interaction terms a model asks for, between two people.
#pragma once

#include <algorithm>
#include <array>
#include <type_traits>

#include "models/contact.h"
#include "models/ldp_interaction.h"
#include "models/network_interaction.h"
#include "models/options.h"
#include "models/pair.h"

namespace pushid {

// The parts of contact, which ForEachTerm joins.
struct ContactPart {};

// Calls visit with the term that a row names.
template <typename Term>
struct TermOfRow {};
template <typename Term, typename Visit>
void VisitRow(TermOfRow<Term>, const InteractionNetwork*, const Visit& visit) {
  visit(Term{});
}
template <typename Visit>
void VisitRow(TermOfRow<NetworkTerm>, const InteractionNetwork* network, const Visit& visit) {
  if (network != nullptr) visit(NetworkTerm{network});
}
template <typename Visit>
void VisitRow(TermOfRow<ContactPart>, const InteractionNetwork*, const Visit&) {}

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
#define PUSHID_TERM(member, near, Term, ...) \
  if (terms.member) VisitRow(TermOfRow<Term>{}, network, visit);
  PUSHID_INTERACTION_TERMS(PUSHID_TERM)
#undef PUSHID_TERM
}

// The place of a term's force among the parts that pairs make.
template <typename Term, typename = void>
struct PairPartOf {
  static constexpr int value = 0;
};
template <typename Term>
struct PairPartOf<Term, std::void_t<decltype(Term::kPart)>> {
  static constexpr int value = static_cast<int>(Term::kPart) - static_cast<int>(kFirstPairPart);
  static_assert(0 <= value && value < kNumPairParts, "no part that pairs make (options.h)");
};

// What two people do to each other, by part, from kFirstPairPart on.
template <typename T>
struct PairForces {
  std::array<PairForce<T>, kNumPairParts> part;

  bool acts() const {
    return std::any_of(part.begin(), part.end(), [](const PairForce<T>& f) { return f.acts; });
  }
  PairForce<T> Sum() const {
    PairForce<T> sum = part[0];
    for (int i = 1; i < kNumPairParts; ++i) {
      sum.on_n += part[i].on_n;
      sum.on_j += part[i].on_j;
    }
    sum.acts = acts();
    return sum;
  }
};

template <typename T>
PairForces<T> PairForcesBetween(const InteractionTerms& terms, const InteractionNetwork* network,
                                const Pair& pair, const ParameterSet<T>& p,
                                const PosedPendulum<T>& n, const PosedPendulum<T>& j) {
  PairForces<T> forces;
  ForEachTerm(terms, network, [&](auto term) {
    term.Add(pair, p, n, j, &forces.part[PairPartOf<decltype(term)>::value]);
  });
  return forces;
}

// All of it together.
template <typename T>
PairForce<T> InteractionBetween(const InteractionTerms& terms, const InteractionNetwork* network,
                                const Pair& pair, const ParameterSet<T>& p,
                                const PendulumState<T>& n, const PendulumState<T>& j) {
  return PairForcesBetween<T>(terms, network, pair, p, n, j).Sum();
}

}  // namespace pushid
