// ident: generators of groups: trained anew for every fold, so that nothing has seen the recordings
// it is judged on.
//
//   generator                  the forecast, of the frames that were not shown
//   generator_all_frames       the recording as far as it is shown, then the forecast
//   generator_unblended        without the physics that the forecast is blended with
//   rigid                      those physics alone, first poses carried by the rods' tips
//   generator_shown_20         shown 20 frames, no physics
//   static, constant_velocity  as in body_evaluation.h, shown as many frames as the generator
//
// All but generator_all_frames and generator_shown_20 count the frames that the generator was not
// shown; generator_shown_20 counts those after its 20.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ident/bodies/body_evaluation.h"
#include "ident/problem/folds.h"
#include "ident/training/generator_training.h"
#include "ident/training/restoration_chain.h"

namespace pushid {

struct GeneratorValidationOptions {
  int observed = 20;  // frames that the generator is shown; 1: the first pose, and the push
  FoldScheme scheme = FoldScheme::kStratified;
  int folds = 0;
  std::optional<FitOptions> physics;  // of the pendulum, fitted in every fold too
  GeneratorChanges changes;           // as in its use
};

struct GeneratorValidation {
  BodyEvaluation evaluation;  // every recording as forecast by the fold that did not see it
  std::vector<double> training_seconds;
};

// Errors: folds that cannot be made, recordings that are too short, a fold whose pendulum finds no
// optimum.
Result<GeneratorValidation> CrossValidateGenerator(const std::vector<BodyRecording>& recordings,
                                                   const GeneratorTrainingOptions& options,
                                                   const GeneratorValidationOptions& validation,
                                                   const RunProgress& progress = nullptr);

}  // namespace pushid
