// residuals: derivatives of what acts on one person in one step, which the adjoint chains back.
#pragma once

#include <Eigen/Core>

#include "models/interaction.h"
#include "models/learned_terms.h"
#include "models/net_force.h"
#include "residuals/frame_residual.h"

namespace pushid {

// Jacobian of NetForceAt, for sliding feet without a delay and a body that is a point.
void NetForceJacobian(const Scene& scene, const ModelOptions& options, const SelfForce& self,
                      const ParameterSet<double>& p, int person, int frame,
                      const PendulumState<double>& state, const Vector4<double>& previous,
                      SelfForce::Jacobian* jacobian);

// d(force on n, force on j) / d(state of n, state of j, pair parameters) of two people, but for
// what is learned.
struct PairJacobian {
  Eigen::Matrix<double, 8, 16> by_states;  // rows: n then j; columns [q, qd] of n, then of j
  Eigen::Matrix<double, 8, kNumPairParameters> by_parameter;  // from kFirstPairParameter on
};
PairJacobian ComputePairJacobian(const InteractionTerms& terms, const Pair& pair,
                                 const ParameterSet<double>& p, const PendulumState<double>& n,
                                 const PendulumState<double>& j);

// The gate of a learned interaction (models/learned_terms.h) by [q of n, q of j] and by the
// contact's parameters, the first of a pair's.
inline constexpr int kContactParameters = kContactHeight - kContactStiffness + 1;
static_assert(kContactStiffness == kFirstPairParameter && kContactParameters == 5);
struct GateJacobian {
  double gate = 0.0;
  Eigen::Matrix<double, 1, 8> by_places;
  Eigen::Matrix<double, 1, kContactParameters> by_parameter;
};
GateJacobian PairGateJacobian(const PairShape& shape, const Pair& pair,
                              const ParameterSet<double>& p, const Vector4<double>& q_n,
                              const Vector4<double>& q_j);

// From derivatives by the network's inputs of n, who meets j, to those by [q, qd] of n, then of j.
Eigen::Matrix<double, 1, 16> PairInputsByStates(
    const Eigen::Matrix<double, 1, PairShape::kInputs>& by_input);

// FrameResidual of a person at a frame, and its derivative by [q, qd, rod, lift]; lift: of the
// cart (BodyNow).
using FrameJacobian = Eigen::Matrix<double, kFrameResiduals, 10>;
FrameVector<double> FrameResidualWithJacobian(const Body& body, double lift,
                                              const PendulumState<double>& state,
                                              const MeasuredFrame& measured,
                                              const ResidualSigmas& sigmas,
                                              FrameJacobian* jacobian);

}  // namespace pushid
