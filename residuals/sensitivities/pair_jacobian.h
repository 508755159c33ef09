// residuals: derivatives of what two people do to each other.
//
// Contact, the term that most fits have, is chained from three small pieces: the points' places and
// velocities by the states, the force by those and the parameters, the generalized force by force
// and state. Jets over both states cost 2.9 times as much (tests/benchmarks, Jacobian_OfContact).
#pragma once

#include <Eigen/Core>

#include "models/interaction.h"

namespace pushid {

// Those of contact are the first of a pair's.
inline constexpr int kContactParameters = kContactHeight - kContactStiffness + 1;
static_assert(kContactStiffness == kFirstPairParameter && kContactParameters == 5);

// d(force on n, force on j) / d(state of n, state of j, pair parameters) of two people, but for
// what is learned (learned_pair_jacobian.h).
struct PairJacobian {
  Eigen::Matrix<double, 8, 16> by_states;  // rows: n then j; columns [q, qd] of n, then of j
  Eigen::Matrix<double, 8, kNumPairParameters> by_parameter;  // from kFirstPairParameter on
};

PairJacobian ComputePairJacobian(const InteractionTerms& terms, const InteractionNetwork* network,
                                 const Pair& pair, const ParameterSet<double>& p,
                                 const PosedPendulum<double>& n, const PosedPendulum<double>& j);

}  // namespace pushid
