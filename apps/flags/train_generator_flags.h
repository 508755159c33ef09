// apps: the flags of pushid-train-generator.
#pragma once

#include <optional>
#include <string>

#include "ident/training/generator_crossvalidation.h"

namespace pushid {

struct TrainGeneratorFlags {
  GeneratorTrainingOptions options;
  std::string folder;     // of clips
  bool hold_out = true;   // validation clips, or a share of the recordings, show how it goes
  int observed = 1;       // frames of a recording that the generator is shown
  std::string out;        // folder of the generator
  int crossvalidate = 0;  // folds, instead of writing a generator; 0: off
  FoldScheme scheme = FoldScheme::kStratified;
  std::optional<FitOptions> physics;  // of the pendulum
  GeneratorChanges changes;           // how held-out recordings are forecast
  std::string json_out;               // scores of the cross-validation; empty: none
};
TrainGeneratorFlags TrainGeneratorFlagsFromCommandLine();

}  // namespace pushid
