// ident: profiles and bootstrap of a finished fit.
#pragma once

#include <string>
#include <vector>

#include "ident/results/fit_result.h"

namespace pushid {

// result must come from Fit of these very recordings.
MaybeError AddProfiles(const std::vector<PendulumRecording>& recordings,
                       const std::vector<std::string>& names, int num_threads,
                       const JobProgress& progress, FitResult* result);
MaybeError AddBootstrap(const std::vector<PendulumRecording>& recordings,
                        const BootstrapOptions& options, const JobProgress& progress,
                        FitResult* result);

}  // namespace pushid
