// ident: a training's state in a file, good only for the very same training.
#pragma once

#include <string>
#include <vector>

#include "ident/training/restoration_training.h"

namespace pushid {

class Checkpoint {
 public:
  // key: what the training depends on, data included; an empty path: no checkpoints.
  Checkpoint(std::string path, const std::string& key, double seconds);

  // The state and the curve so far, when there is a checkpoint with this key.
  bool Load(std::string* state, std::vector<TrainingPoint>* curve) const;
  // Whether the last one is old enough for another.
  bool Due() const;
  MaybeError Save(const std::string& state, const std::vector<TrainingPoint>& curve);
  void Remove() const;  // after a training that was finished

 private:
  std::string path_, key_;
  double seconds_, last_;
};

// What a training depends on.
std::string KeyOfTraining(const std::vector<RestorationSample>& training,
                          const std::vector<RestorationSample>& held,
                          const RestorationTrainingOptions& options);

// A hash of everything a sample holds.
std::string KeyOfSamples(const std::vector<RestorationSample>& samples);

}  // namespace pushid
