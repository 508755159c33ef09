// ident: siMLPe (simlpe.h) as a file, and its scores.
#pragma once

#include <string>

#include "ident/bodies/body_evaluation.h"
#include "ident/bodies/restoration_files.h"
#include "models/restoration/simlpe.h"

namespace pushid {

void AddTensors(const SimlpeWeights& weights, TensorList* tensors);
// Errors: another kind, missing or misshapen tensors.
Result<SimlpeWeights> MakeSimlpe(const RestorationFile& file, const std::string& folder);
Result<SimlpeWeights> LoadSimlpe(const std::string& folder);

// "simlpe": over all frames, the 12 given ones among them without error; "simlpe_after_given": over
// the frames after them. A recording that is too short fails by name.
void ScoreSimlpe(const SimlpeWeights& weights, const BodyRecording& recording, BodyScores* scores);

}  // namespace pushid
