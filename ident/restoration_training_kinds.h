// ident: the trainings of the kinds that have a file of their own; see restoration_training.h.
#pragma once

#include <vector>

#include "ident/restoration_training.h"

namespace pushid {

Result<TrainedRestoration> TrainCvae(const std::vector<RestorationSample>& training,
                                     const std::vector<RestorationSample>& held,
                                     const RestorationTrainingOptions& options,
                                     const TrainingProgress& progress);

}  // namespace pushid
