// models: the sum of the interaction terms a model asks for, between two people.
#pragma once

#include <type_traits>

#include "models/contact.h"
#include "models/ldp_interaction.h"
#include "models/options.h"
#include "models/pair.h"

namespace pushid {

// The parts of contact, which ForEachTerm joins.
struct ContactPart {};

// Calls visit with the term that a row names.
template <typename Term>
struct TermOfRow {};
template <typename Term, typename Visit>
void VisitRow(TermOfRow<Term>, const Visit& visit) {
  visit(Term{});
}
template <typename Visit>
void VisitRow(TermOfRow<ContactPart>, const Visit&) {}

// Calls visit(term) for every term of the model that acts between two people.
template <typename Visit>
void ForEachTerm(const InteractionTerms& terms, Visit&& visit) {
  if (terms.spring && terms.damping) {
    visit(ContactTerm<true, true>{});
  } else if (terms.spring) {
    visit(ContactTerm<true, false>{});
  } else if (terms.damping) {
    visit(ContactTerm<false, true>{});
  }
#define PUSHID_TERM(member, near, Term, ...) \
  if (terms.member) VisitRow(TermOfRow<Term>{}, visit);
  PUSHID_INTERACTION_TERMS(PUSHID_TERM)
#undef PUSHID_TERM
}

// What two people do to each other; their poses as PosedPendulum or, to be posed here, as states.
template <typename T>
PairForce<T> InteractionBetween(const InteractionTerms& terms, const Pair& pair,
                                const ParameterSet<T>& p,
                                const std::common_type_t<PosedPendulum<T>>& n,
                                const std::common_type_t<PosedPendulum<T>>& j) {
  PairForce<T> force;
  ForEachTerm(terms, [&](auto term) { term.Add(pair, p, n, j, &force); });
  return force;
}

}  // namespace pushid
