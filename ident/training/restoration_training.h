// ident: training of restorations on samples, with checkpoints. Needs LibTorch (behind models/).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "ident/bodies/restoration_files.h"
#include "ident/training/restoration_data.h"
#include "models/restoration/cvae_features.h"
#include "models/restoration/mrt_network.h"
#include "models/restoration/regression_trainer.h"
#include "models/restoration/restoration_view.h"

namespace pushid {

struct RestorationTrainingOptions {
  RestorationKind kind = RestorationKind::kWindow;
  RestorationView view = RestorationView::kPendulum;    // of kWindow and kCvae
  CvaeCoordinates coordinates = CvaeCoordinates::kTip;  // of kCvae
  bool halves = true;                                   // of kCvae: lower, then upper body
  MrtSize mrt_size = MrtSize::kSmall;                   // of kMrt
  double effort = 1.0;                                  // multiplies the number of steps
  uint64_t seed = 1;
  int num_threads = 1;
  std::string checkpoint;            // file; empty: none
  double checkpoint_seconds = 20.0;  // between two
};

// done: share of all steps, 0 .. 1.
using TrainingProgress = std::function<void(const TrainingPoint& point, double done)>;

struct TrainedRestoration {
  RestorationFile file;
  std::vector<TrainingPoint> curve;
  bool resumed = false;
};

// training, held: samples to learn from and to stop early by. Errors: a kind without training, a
// checkpoint that cannot be written. A checkpoint of other data or options is not used.
Result<TrainedRestoration> TrainRestoration(const std::vector<RestorationSample>& training,
                                            const std::vector<RestorationSample>& held,
                                            const RestorationTrainingOptions& options,
                                            const TrainingProgress& progress = nullptr);

}  // namespace pushid
