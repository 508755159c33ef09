// ident: options made fit for recordings, and what recordings cannot be fitted by them.
#pragma once

#include <vector>

#include "datasets/files/error.h"
#include "datasets/loading/pendulum_recording.h"
#include "ident/parameters/fit_options.h"

namespace pushid {

// Makes options fit for these recordings: holds what can have no effect on any of them (the tail,
// where every push is measured whole), pools nothing where all belong to one unit, and adds the
// slopes of covariates and contrasts to the table (covariates.h). Errors: invalid options, nothing
// left to fit, a free parameter without effect, those of AddCovariates and CheckLaboratory.
// warnings (may be null): people who touch without any term between them; masses, rods, pushes and
// motions that no person has. Every fit begins with it: of the programs, of cross-validation, of
// users of the library.
MaybeError PrepareFit(const std::vector<PendulumRecording>& recordings, FitOptions* options,
                      Warnings* warnings = nullptr);

// Whether a model with a delay, moving ground, platforms or other bodies fits recordings. Errors
// name the recording, what does not go together and what to do: a delay beyond a recording, masses
// from the table where feet stand, platforms under people who touch, anything of it with networks
// that are trained by their gradient.
MaybeError CheckLaboratory(const std::vector<PendulumRecording>& recordings,
                           const FitOptions& options);

}  // namespace pushid
