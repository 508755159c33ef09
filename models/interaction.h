// models: the sum of the interaction terms a model asks for, between two people.
#pragma once

#include <type_traits>

#include "models/contact.h"
#include "models/ldp_interaction.h"
#include "models/options.h"
#include "models/pair.h"

namespace pushid {

// What two people do to each other; their poses as PosedPendulum or, to be posed here, as states.
template <typename T>
PairForce<T> InteractionBetween(const InteractionTerms& terms, const Pair& pair,
                                const ParameterSet<T>& p,
                                const std::common_type_t<PosedPendulum<T>>& n,
                                const std::common_type_t<PosedPendulum<T>>& j) {
  PairForce<T> force;
  if (terms.spring && terms.damping) {
    ContactTerm<true, true>::Add(pair, p, n, j, &force);
  } else if (terms.spring) {
    ContactTerm<true, false>::Add(pair, p, n, j, &force);
  } else if (terms.damping) {
    ContactTerm<false, true>::Add(pair, p, n, j, &force);
  }
  if (terms.ldp_published) LdpPublishedTerm::Add(pair, p, n, j, &force);
  return force;
}

}  // namespace pushid
