// residuals: derivatives of feet that stand and step (models/stance.h), and of those that hold
// (models/standing.h), beside those of the rollout (rollout_sensitivities.h).
//
// With v' = v + dt a the cart's velocity after a step, u that of the feet and D the ground's
// resistance, which is constant,
//   (M + dt D E) da = d(F - C - G) at fixed a - D (dv - du),   E = diag(1, 1, 0, 0).
// The torques, u and the feet after the step depend on few numbers: jets over these
// (residuals/lanes/stance_jet.h). Which foot steps has no derivative (models/stance.h).
#pragma once

#include "residuals/sensitivities/net_force_jacobian.h"

namespace pushid {

inline constexpr int kFeetStates = 4;  // apart, clock, swing_time

// Derivatives of one step of one person, the parts that depend on the feet.
struct StanceJacobian {
  Eigen::Matrix<double, 4, kFeetStates> by_feet;  // of F + D u at fixed a
  // Of the feet after the step: by [q, qd], by what is perceived, where late, and by the feet.
  Eigen::Matrix<double, kFeetStates, 8> next_by_state, next_by_ankle, next_by_foot;
  Eigen::Matrix<double, kFeetStates, kFeetStates> next_by_feet;
  Eigen::Matrix<double, kFeetStates, kNumParameters> next_by_parameter;

  void SetZero() {
    by_feet.setZero();
    next_by_state.setZero();
    next_by_ankle.setZero();
    next_by_foot.setZero();
    next_by_parameter.setZero();
  }
};

// The analytic twin of NetForceAt where feet stand and step, without what others do: jacobian: of
// F - D (v' - u) at fixed acceleration a. All but by_previous (zero) and the stance's are
// overwritten. perceived, by_perceived: as NetForceJacobian has them.
void NetForceJacobianOfStance(const Scene& scene, const ModelOptions& options,
                              const SelfForce& self, const ParameterSet<double>& p, int person,
                              int frame, const PosedPendulum<double>& state,
                              SelfForce::Jacobian* jacobian, StanceJacobian* stance,
                              const Perceived<double>* perceived = nullptr,
                              PerceivedJacobian* by_perceived = nullptr);

// The same where feet hold, whatever happens; jacobian: of what the ankles and the ground do,
// without what the height of the centre of mass changes of M a + C + G (net_force_jacobian.h).
void NetForceJacobianOfStanding(const Scene& scene, const ModelOptions& options,
                                const SelfForce& self, const ParameterSet<double>& p, int person,
                                int frame, const PendulumState<double>& state,
                                SelfForce::Jacobian* jacobian,
                                const Perceived<double>* perceived = nullptr,
                                PerceivedJacobian* by_perceived = nullptr);

}  // namespace pushid
