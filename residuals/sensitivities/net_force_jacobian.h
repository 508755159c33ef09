// residuals: derivatives of what acts on a person alone (models/net_force.h), written out.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/interaction.h"
#include "models/net_force.h"
#include "models/rollout.h"

namespace pushid {

// Derivatives of forces by what control perceives, where it is late.
struct PerceivedJacobian {
  Eigen::Matrix<double, 4, 8> by_ankle, by_step;  // over [q, qd] of each

  void SetZero() {
    by_ankle.setZero();
    by_step.setZero();
  }
};

// Derivatives of NetForceAt: the analytic twin. perceived: as NetForceAt has it; what it changes is
// then not in by_state but in by_perceived.
void NetForceJacobian(const Scene& scene, const ModelOptions& options, const SelfForce& self,
                      const ParameterSet<double>& p, int person, int frame,
                      const PendulumState<double>& state, const Vector4<double>& previous,
                      SelfForce::Jacobian* jacobian, const Perceived<double>* perceived = nullptr,
                      PerceivedJacobian* by_perceived = nullptr);

// One step of everybody with its derivatives by each person's own state: the analytic
// twin of DualStep (models/pendulum_filter.h), chained from the pieces that rollouts' sensitivities
// are chained from, at a quarter of its cost.

class StepJacobian {
 public:
  // All arguments must outlive the object. For models whose state is place and velocity.
  StepJacobian(const Scene& scene, const ModelOptions& options,
               const std::vector<ParameterSet<double>>& parameters)
      : scene_(scene), options_(options), forces_(scene, options, parameters) {}

  void Begin(const std::vector<PendulumState<double>>& states);
  Vector4<double> Velocity(int frame, int person, Eigen::Matrix<double, 4, 8>* by_state);

 private:
  const Scene& scene_;
  const ModelOptions& options_;
  SceneForces<double> forces_;
};

// Derivatives of what two people do to each other.
//
// Contact, the term that most fits have, is chained from three small pieces: the points' places and
// velocities by the states, the force by those and the parameters, the generalized force by force
// and state. Jets over both states cost 2.9 times as much (tests/benchmarks, Jacobian_OfContact).

// Those of contact are the first of a pair's.
inline constexpr int kContactParameters = kContactHeight - kContactStiffness + 1;
static_assert(kContactStiffness == kFirstPairParameter && kContactParameters == 5);

// d(force on n, force on j) / d(state of n, state of j, pair parameters) of two people, but for
// what is learned (learned_pair_jacobian.h).
struct PairJacobian {
  Eigen::Matrix<double, 8, 16> by_states;  // rows: n then j; columns [q, qd] of n, then of j
  Eigen::Matrix<double, 8, kNumPairParameters> by_parameter;  // from kFirstPairParameter on
};

PairJacobian ComputePairJacobian(const InteractionTerms& terms, const Pair& pair,
                                 const ParameterSet<double>& p, const PosedPendulum<double>& n,
                                 const PosedPendulum<double>& j);

// Derivatives by what decides a body's masses: the height of the centre of mass of who
// stands, and the masses that the table gives (models/ipm.h).

// Parameters that decide the body of a step (DynamicBody).
inline constexpr Parameter kBodyParameters[] = {kComHeight, kCartMassShare, kGyrationRadius};
inline constexpr int kNumBodyParameters = 3;

// d [log of the point's mass, log of the pendulum's length] / d kBodyParameters.
using BodyByParameters = Eigen::Matrix<double, 2, kNumBodyParameters>;
BodyByParameters BodyJacobian(const ModelOptions& options, const Body& body,
                              const ParameterSet<double>& p, bool holds_fast);

// Derivatives of HoldOfTable by kBodyParameters.
Eigen::Matrix<double, 2, kNumBodyParameters> HoldOfTableJacobian(const SelfForce& self,
                                                                 const ParameterSet<double>& p);

}  // namespace pushid
