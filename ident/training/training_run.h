// ident: a training run to its end, and its state in a file, which is good for the very same
// training alone.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "models/restoration/trainer.h"

namespace pushid {

struct CheckpointOptions {
  std::string checkpoint;            // file; empty: none
  double checkpoint_seconds = 20.0;  // between two
};

// How a training went.
struct TrainingCourse {
  std::vector<TrainingPoint> curve;
  bool resumed = false;
};

// Until the trainer is done, from a checkpoint of this key on if there is one; the last stays until
// it is removed. key: what the training depends on, data included. told: about every new point,
// whose stage it may name. The points are added to the course. Errors: a checkpoint that cannot be
// written.
MaybeError RunToEnd(Trainer* trainer, const std::string& key, const CheckpointOptions& options,
                    const std::function<void(TrainingPoint* point)>& told, TrainingCourse* course);

void RemoveCheckpoint(const std::string& file);

}  // namespace pushid
