// residuals: derivatives by what decides a body's masses: the height of the centre of mass of who
// stands, and the masses that the table gives (models/mass_distribution.h).
#pragma once

#include "models/net_force.h"

namespace pushid {

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
