// ident: networks too large for Gauss-Newton inside an ordinary fit: first the physical model
// without them, then their weights by the adjoint gradient and L-BFGS (large_network_fit.h), and
// then the physical parameters again, with the network held as it is.
//
// The weights learn beside the first step's parameters, those of each setting or person where they
// differ, and count the data as that step does: its sigmas and its weight of the recordings.
#pragma once

#include "ident/parameters/fit_options.h"
#include "ident/solver/solver.h"

namespace pushid {

// The fit without its network: the first of the steps.
FitOptions PhysicsAlone(FitOptions options);

// What the first step found.
struct FittedPhysics {
  FitOptions options;  // PhysicsAlone's, with what was estimated
  FitPoint point;
};

// The options of the last of the three steps: the trained network, held, and the physical
// parameters' values to start from. Errors: what the adjoint gradient refuses (free initial
// velocities).
Result<FitOptions> TrainLargeNetwork(const std::vector<PendulumRecording>& recordings,
                                     const FitOptions& options, const FittedPhysics& physics,
                                     const SolveProgress& progress);

}  // namespace pushid
