// ident: generators of groups: trained anew for every fold, so that nothing has seen the recordings
// it is judged on.
//
//   generator                  the forecast, of the frames that were not shown
//   generator_all_frames       the recording as far as it is shown, then the forecast
//   generator_unblended        without the physics that the forecast is blended with
//   generator_blend_0.25       the same with another share of physics, where such are compared
//   rigid                      those physics alone, first poses carried by the rods' tips
//   generator_shown_20         shown 20 frames, no physics; not where shares of physics are
//                              compared
//   static, constant_velocity  as in body_evaluation.h, shown as many frames as the generator
//
// All but generator_all_frames and generator_shown_20 count the frames that the generator was not
// shown; generator_shown_20 counts those after its 20.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ident/bodies/body_evaluation.h"
#include "ident/forecasts/group_forecasts.h"
#include "ident/problem/folds.h"
#include "ident/training/generator_training.h"
#include "ident/training/restoration_chain.h"

namespace pushid {

struct GeneratorValidationOptions {
  int observed = 20;  // frames that the generator is shown; 1: the first pose, and the push
  FoldScheme scheme = FoldScheme::kStratified;
  int folds = 0;
  std::optional<FitOptions> physics;            // of the pendulum, fitted in every fold too
  GeneratorChanges changes;                     // as in its use
  std::vector<double> blends;                   // to compare with, besides that of changes
  int samples = 0;                              // futures of diffusion for every recording; 0: none
  std::vector<IdentifiedModel> pendulums = {};  // in place of physics, by fold: fitted already
};

struct GeneratorValidation : ChainValidation {
  // Of the sampled futures of recordings held out, and of such that differ by noise alone.
  GroupSpread spread, noise_alone;
};

// Errors: folds that cannot be made, recordings that are too short, a fold whose pendulum finds no
// optimum.
Result<GeneratorValidation> CrossValidateGenerator(const std::vector<BodyRecording>& recordings,
                                                   const GeneratorTrainingOptions& options,
                                                   const GeneratorValidationOptions& validation,
                                                   const RunProgress& progress = nullptr);

// The kind that forecasts groups best. Physics, restored bodies and diffusion are trained in every
// fold and judged on the recordings held out; the one with the smallest mean joint error is chosen,
// and it is then trained on all recordings.

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
