// ident: whether a model with a delay, moving ground, platforms or other bodies fits recordings.
#pragma once

#include <vector>

#include "datasets/files/error.h"
#include "datasets/loading/pendulum_recording.h"
#include "ident/parameters/fit_options.h"

namespace pushid {

// Errors name the recording, what does not go together and what to do: a delay beyond a recording,
// masses from the table where feet stand, platforms under people who touch, anything of it with
// networks that are trained by their gradient.
MaybeError CheckLaboratory(const std::vector<PendulumRecording>& recordings,
                           const FitOptions& options);

}  // namespace pushid
