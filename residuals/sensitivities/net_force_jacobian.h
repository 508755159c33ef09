// residuals: derivatives of what acts on a person alone (models/net_force.h), written out.
#pragma once

#include "models/net_force.h"

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

}  // namespace pushid
