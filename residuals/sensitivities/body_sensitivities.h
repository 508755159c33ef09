// residuals: derivatives by the masses that the table gives a body (models/mass_distribution.h);
// those of the net force, NetForceJacobian, stand beside them in the source file.
#pragma once

#include "residuals/sensitivities/rollout_sensitivities.h"

namespace pushid {

// Subtracts d(M a + C + g_n / g G)/d(the table's masses) at fixed acceleration a from the
// derivatives by parameter. gravity: g_n, m/s^2.
void SubtractInverseDynamicsByMasses(const Body& body, const ParameterSet<double>& p,
                                     const PendulumState<double>& state, const Vector4<double>& a,
                                     double gravity, SelfForce::Jacobian* jacobian);

}  // namespace pushid
