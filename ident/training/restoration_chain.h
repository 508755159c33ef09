// ident: a whole training from recordings: pendulums predicted out of fold, samples, held-out
// recordings; and its cross-validation, in which pendulum and restoration are fitted anew for
// every fold, so that nothing has seen the recordings it is judged on.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "ident/bodies/body_evaluation.h"
#include "ident/problem/folds.h"
#include "ident/training/restoration_training.h"

namespace pushid {

struct RestorationRunOptions {
  FitOptions fit;  // of the pendulum
  RestorationTrainingOptions training;
  PostprocessOptions postprocess;
  int observed = 0;  // frames that held-out recordings show first (prediction/online_predictor.h)
  // Recordings of other settings to learn from too, with their recorded pendulums; never judged.
  std::vector<BodyRecording> more;
};

// A pendulum's model and the restoration of its bodies, learned from the same recordings.
struct TrainedChain {
  IdentifiedModel model;
  TrainedRestoration restoration;
};

// step: "pendulum 2/4", "window epoch 12"; done: share of this step.
using RunProgress = std::function<void(const std::string& step, double done)>;

// Learns from the recordings with these indices.
Result<TrainedRestoration> TrainFromRecordings(const std::vector<BodyRecording>& recordings,
                                               const std::vector<int>& among,
                                               const RestorationRunOptions& options,
                                               const RunProgress& progress = nullptr);

// The pendulum fitted and a restoration trained on it. It keeps no checkpoint. Errors: those of
// either; a fit that finds no optimum.
Result<TrainedChain> TrainChain(const std::vector<BodyRecording>& recordings,
                                const std::vector<int>& among, const RestorationRunOptions& options,
                                const RunProgress& progress = nullptr);

struct ChainValidation {
  // Every recording as predicted by the fold that did not see it. Of a cvae, restoration_drawn has
  // the mean of the scores of three draws of the latent variable, and restoration is by its mean.
  BodyEvaluation evaluation;
  std::vector<double> training_seconds;  // of pendulum and restoration, by fold
};
// Errors: folds that cannot be made; a fold whose pendulum fit finds no optimum, or which cannot
// learn from first frames where some are to be seen.
Result<ChainValidation> CrossValidateChain(const std::vector<BodyRecording>& recordings,
                                           const RestorationRunOptions& options, FoldScheme scheme,
                                           int folds, const RunProgress& progress = nullptr);

}  // namespace pushid
