// residuals: derivatives of feet that stand and step (models/stance.h), and of those that hold
// (models/standing.h), beside those of the rollout (rollout_sensitivities.h).
//
// With v' = v + dt a the cart's velocity after a step and D the ground's resistance,
//   (M + dt D E) da = d(F - C - G) at fixed a - D dv - v' dD,   E = diag(1, 1, 0, 0),
//   ds' = s'_[q,qd] S + s'_s ds + s'_p dp.
// The torques, D and s' depend on few numbers: dual numbers over these; the cart's own forces come
// with the Jacobian of the self force, which is written out.
#pragma once

#include "residuals/sensitivities/net_force_jacobian.h"

namespace pushid {

// Derivatives of one step of one person, the parts that depend on the step state.
struct StanceJacobian {
  Vector4<double> by_step;                                  // of F - D v' at fixed a, by s
  Eigen::Matrix<double, 1, 8> next_by_state;                // of s' by [q, qd]
  Eigen::Matrix<double, 1, 8> next_by_ankle, next_by_foot;  // by what is perceived, where late
  double next_by_step = 0.0;                                // by s
  Eigen::Matrix<double, 1, kNumParameters> next_by_parameter;
};

// The analytic twin of NetForceAt where feet stand and step, without what others do: jacobian: of
// F - D v' at fixed acceleration a. All but by_previous (zero) and the stance's are overwritten.
// perceived, by_perceived: as NetForceJacobian has them.
void NetForceJacobianOfStance(const Scene& scene, const ModelOptions& options,
                              const SelfForce& self, const ParameterSet<double>& p, int person,
                              int frame, const PendulumState<double>& state,
                              const Vector4<double>& a, SelfForce::Jacobian* jacobian,
                              StanceJacobian* stance, const Perceived<double>* perceived = nullptr,
                              PerceivedJacobian* by_perceived = nullptr);

// The same where feet hold, whatever happens; jacobian: of what the ankles and the ground do,
// without what the height of the centre of mass changes of M a + C + G (body_sensitivities.h).
void NetForceJacobianOfStanding(const Scene& scene, const ModelOptions& options,
                                const SelfForce& self, const ParameterSet<double>& p, int person,
                                int frame, const PendulumState<double>& state,
                                SelfForce::Jacobian* jacobian,
                                const Perceived<double>* perceived = nullptr,
                                PerceivedJacobian* by_perceived = nullptr);

}  // namespace pushid
