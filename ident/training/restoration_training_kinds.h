// ident: the trainings of the kinds that have a file of their own; see restoration_training.h.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "ident/training/restoration_training.h"
#include "ident/training/restoration_training_checkpoint.h"

namespace pushid {

Result<TrainedRestoration> TrainCvae(const std::vector<RestorationSample>& training,
                                     const std::vector<RestorationSample>& held,
                                     const RestorationTrainingOptions& options,
                                     const TrainingProgress& progress);

// Peers learn from the true motions alone: siMLPe from people one by one, MRT from whole groups.
Result<TrainedRestoration> TrainSimlpe(const std::vector<RestorationSample>& training,
                                       const std::vector<RestorationSample>& held,
                                       const RestorationTrainingOptions& options,
                                       const TrainingProgress& progress);
Result<TrainedRestoration> TrainMrt(const std::vector<RestorationSample>& training,
                                    const std::vector<RestorationSample>& held,
                                    const RestorationTrainingOptions& options,
                                    const TrainingProgress& progress);

// `epochs` times the options' effort of a dense network, or until it is done, with checkpoints
// under `key`. Adds points to trained->curve; returns the best weights.
Result<DenseNetwork> TrainDense(const RegressionSamples& learnt, const RegressionSamples& judged,
                                int epochs, const std::string& key,
                                const RestorationTrainingOptions& options,
                                const TrainingProgress& progress, TrainedRestoration* trained);

inline int EpochsOf(int epochs, const RestorationTrainingOptions& options) {
  return std::max(1, static_cast<int>(std::lround(epochs * options.effort)));
}

// Until the trainer is done, from a checkpoint under `key` if there is one. run: one round of it, a
// point of the curve; share: done of the whole, 0 .. 1. Errors: a checkpoint that cannot be
// written.
template <typename Trainer, typename Run, typename Share>
MaybeError RunRounds(Trainer* trainer, const Run& run, const Share& share, const std::string& key,
                     const RestorationTrainingOptions& options, const TrainingProgress& progress,
                     TrainedRestoration* trained) {
  Checkpoint checkpoint(options.checkpoint, key, options.checkpoint_seconds);
  std::string state;
  trained->resumed = checkpoint.Load(&state, &trained->curve) && trainer->Resume(state);
  if (!trained->resumed) trained->curve.clear();
  while (!trainer->Done()) {
    trained->curve.push_back(run());
    if (progress) progress(trained->curve.back(), share(trained->curve.back()));
    if (!checkpoint.Due() || trainer->Done()) continue;
    if (MaybeError error = checkpoint.Save(trainer->State(), trained->curve)) return *error;
  }
  checkpoint.Remove();
  return std::nullopt;
}

// Of a trainer that goes by epochs.
template <typename Trainer>
MaybeError RunEpochs(Trainer* trainer, int epochs, const std::string& key,
                     const RestorationTrainingOptions& options, const TrainingProgress& progress,
                     TrainedRestoration* trained) {
  return RunRounds(
      trainer, [trainer] { return trainer->RunEpoch(); },
      [epochs](const TrainingPoint& point) { return static_cast<double>(point.epoch) / epochs; },
      key, options, progress, trained);
}

}  // namespace pushid
