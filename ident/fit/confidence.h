// ident: profiles, bootstrap and shorter horizons of a finished fit.
#pragma once

#include <string>
#include <vector>

#include "ident/model/fitted_model.h"

namespace pushid {

// model->fit must come from Fit of these very recordings.
MaybeError AddProfiles(const std::vector<PendulumRecording>& recordings,
                       const std::vector<std::string>& names, int num_threads,
                       const JobProgress& progress, FittedModel* model);
MaybeError AddBootstrap(const std::vector<PendulumRecording>& recordings,
                        const BootstrapOptions& options, const JobProgress& progress,
                        FittedModel* model);
// An identified parameter that leaves its interval under other priors becomes weak.
void AddPriorCheck(const std::vector<PendulumRecording>& recordings, FittedModel* model);
void AddHorizonCheck(const std::vector<PendulumRecording>& recordings, int num_threads,
                     const JobProgress& progress, FittedModel* model);

}  // namespace pushid
