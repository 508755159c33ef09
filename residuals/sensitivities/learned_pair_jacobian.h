// residuals: derivatives of a learned interaction (models/learned_pair.h), by hand but for its
// gate.
//
// F = 2 M g y(u, w) of each of the two gives
//   dF/ds = 2 M (g dy/du du/ds + y dg/ds),  dF/dp = 2 M y dg/dp,  dF/dw = 2 M g dy/dw
// with dy/du and dy/dw by backpropagation of the four outputs, and the gate's derivatives by Jets
// over both places and the contact's parameters.
#pragma once

#include "models/learned_pair.h"
#include "residuals/sensitivities/pair_jacobian.h"

namespace pushid {

// d(force on n, force on j) / d(weights).
using PairByWeight = Eigen::Matrix<double, 8, Eigen::Dynamic, Eigen::RowMajor>;

// Adds to the Jacobian of the other terms; by_weight: overwritten, may be null.
void AddLearnedPairJacobian(const PairShape& shape, const double* weights, const Pair& pair,
                            const ParameterSet<double>& p, const PendulumState<double>& n,
                            const PendulumState<double>& j, PairJacobian* jacobian,
                            PairByWeight* by_weight);

}  // namespace pushid
