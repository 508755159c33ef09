// ident: training of restorations on samples, with checkpoints. Needs LibTorch (behind models/).
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "ident/bodies/restoration_files.h"
#include "ident/training/restoration_data.h"
#include "ident/training/training_run.h"
#include "models/peers/mrt_network.h"
#include "models/restoration/cvae_features.h"
#include "models/restoration/regression_trainer.h"
#include "models/restoration/restoration.h"

namespace pushid {

struct RestorationTrainingOptions : TrainerOptions, CheckpointOptions {
  RestorationKind kind = RestorationKind::kWindow;
  RestorationView view = RestorationView::kPendulum;    // of kWindow and kCvae
  CvaeCoordinates coordinates = CvaeCoordinates::kTip;  // of kCvae
  bool halves = true;                                   // of kCvae: lower, then upper body
  MrtSize mrt_size = MrtSize::kSmall;                   // of kMrt
  double effort = 1.0;                                  // multiplies the number of steps
};

struct TrainedRestoration : TrainingCourse {
  RestorationFile file;
};

// What a kind's own function returns (ident/bodies/restoration_kinds.h).
struct RestorationTraining {
  std::shared_ptr<Trainer> trainer;
  std::function<void(RestorationFile* file)> finish;  // settings and tensors of the trained
};
// `epochs` times the options' effort.
int EpochsOf(int epochs, const RestorationTrainingOptions& options);
// A dense network trained on these samples.
std::shared_ptr<RegressionTrainer> DenseTrainer(const RegressionSamples& learnt,
                                                const RegressionSamples& judged, int epochs,
                                                const RestorationTrainingOptions& options);

// training, held: samples to learn from and to stop early by. Errors: a kind without training, a
// checkpoint that cannot be written. A checkpoint of other data or options is not used.
Result<TrainedRestoration> TrainRestoration(const std::vector<RestorationSample>& training,
                                            const std::vector<RestorationSample>& held,
                                            const RestorationTrainingOptions& options,
                                            const TrainingProgress& progress = nullptr);

}  // namespace pushid
