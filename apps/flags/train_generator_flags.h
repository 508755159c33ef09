// apps: the flags of pushid-train-generator.
#pragma once

#include <optional>
#include <string>

#include "ident/training/generator_crossvalidation.h"

namespace pushid {

// best: compares everything that may forecast groups, and keeps what it needs for it.
enum class ForecastAccuracy { kUsual, kBest };
constexpr EnumNames<ForecastAccuracy, 2> Names(ForecastAccuracy) {
  return {{{"usual", ForecastAccuracy::kUsual}, {"best", ForecastAccuracy::kBest}}};
}

struct TrainGeneratorFlags {
  GeneratorTrainingOptions options;
  GeneratorData data = GeneratorData::kCmu;
  ForecastAccuracy accuracy = ForecastAccuracy::kUsual;
  int steps = 0, batch = 0;      // 0: those of the kind
  double learning_rate = 0.0;    // 0: that of the kind
  std::string folder;            // of clips
  bool with_validation = false;  // learn from the validation clips too
  int observed = 0;              // frames of a push that the generator is shown
  double held_out = 0.15;        // share of the recordings that only show how the training goes
  std::string out;               // folder of the generator
  int crossvalidate = 0;         // folds, instead of writing a generator; 0: off
  FoldScheme scheme = FoldScheme::kStratified;
  std::optional<FitOptions> physics;  // of the pendulum
  GeneratorChanges changes;           // how held-out recordings are forecast
  int samples = 0;                    // futures sampled of them; 0: none
  std::string json_out;               // scores of the cross-validation; empty: none
};
TrainGeneratorFlags TrainGeneratorFlagsFromCommandLine();

}  // namespace pushid
