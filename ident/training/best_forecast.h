// ident: whatever forecasts groups best. Physics, restored bodies and diffusion are trained in
// every fold and judged on the recordings held out; the nearest in the mean joint error is the
// choice, and all three are then trained on all recordings, for whoever wants another.
#pragma once

#include <string>
#include <vector>

#include "ident/training/generator_crossvalidation.h"

namespace pushid {

struct BestForecastOptions {
  RestorationRunOptions chain;  // physics in its fit, and the restoration
  GeneratorTrainingOptions generator;
  GeneratorValidationOptions validation;  // folds; blends are those compared
};

struct ForecastCandidate {
  std::string name;
  ForecastChoice choice;
  BodySummary summary;
};
// The best first.
Result<std::vector<ForecastCandidate>> CompareForecasts(
    const std::vector<BodyRecording>& recordings, const BestForecastOptions& options,
    const RunProgress& progress = nullptr);

std::string CandidatesText(const std::vector<ForecastCandidate>& candidates);
nlohmann::ordered_json ToJson(const std::vector<ForecastCandidate>& candidates);

}  // namespace pushid
