// ident: networks too large for Gauss-Newton inside an ordinary fit: first the physical model
// without them, then their weights by the adjoint gradient and L-BFGS (large_network_fit.h), and
// then the physical parameters again, with the network held as it is.
#pragma once

#include "ident/parameters/fit_options.h"
#include "ident/solver/solver.h"

namespace pushid {

// The fit without its network: the first of the steps.
FitOptions PhysicsAlone(FitOptions options);

// The options of the last of the three steps: the trained network, held, and the physical
// parameters' values to start from. Errors: no physical optimum; what the adjoint gradient refuses
// (people who touch, pooled parameters, free initial velocities).
Result<FitOptions> TrainLargeNetwork(const std::vector<PendulumRecording>& recordings,
                                     const FitOptions& options, const SolveProgress& progress);

}  // namespace pushid
