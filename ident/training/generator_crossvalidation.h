// ident: generators on pushes: trained anew for every fold, so that nothing has seen the recordings
// it is judged on.
//
//   generator                  the recording as far as it is shown, then the forecast
//   generator_after_observed   the forecast alone
//   static, constant_velocity  as in body_evaluation.h
#pragma once

#include <vector>

#include "ident/bodies/body_evaluation.h"
#include "ident/training/generator_training.h"
#include "ident/training/restoration_training_run.h"

namespace pushid {

// observed: frames that the generator is shown; 1: the first pose, and the push. Errors: folds that
// cannot be made, recordings that are too short.
Result<ChainValidation> CrossValidateGenerator(const std::vector<BodyRecording>& recordings,
                                               const GeneratorTrainingOptions& options,
                                               int observed, int folds,
                                               const RunProgress& progress = nullptr);

}  // namespace pushid
