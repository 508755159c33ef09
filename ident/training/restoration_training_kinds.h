// ident: the trainings of the kinds that have a file of their own; see restoration_training.h.
#pragma once

#include <vector>

#include "ident/training/restoration_training.h"

namespace pushid {

Result<TrainedRestoration> TrainCvae(const std::vector<RestorationSample>& training,
                                     const std::vector<RestorationSample>& held,
                                     const RestorationTrainingOptions& options,
                                     const TrainingProgress& progress);

// siMLPe learns from the true motions alone.
Result<TrainedRestoration> TrainSimlpe(const std::vector<RestorationSample>& training,
                                       const std::vector<RestorationSample>& held,
                                       const RestorationTrainingOptions& options,
                                       const TrainingProgress& progress);

// `epochs` times the options' effort of a dense network, or until it is done, with checkpoints
// under `key`. Adds points to trained->curve; returns the best weights.
Result<DenseNetwork> TrainDense(const RegressionSamples& learnt, const RegressionSamples& judged,
                                int epochs, const std::string& key,
                                const RestorationTrainingOptions& options,
                                const TrainingProgress& progress, TrainedRestoration* trained);

}  // namespace pushid
