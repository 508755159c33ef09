// ident: what a model sees from ground that moves, as the laboratory sees it: for files and
// pictures. Errors are the same in either.
#pragma once

#include <vector>

#include "ident/prediction/prediction.h"
#include "ident/prediction/predictive_bands.h"
#include "models/restoration/body.h"

namespace pushid {

// Nothing changes where the ground does not move. Paths, hips; net forces get the part of inertia.
Prediction InLaboratory(const PendulumRecording& recording, Prediction prediction);
PendulumRecording InLaboratory(PendulumRecording recording);
void ToLaboratory(const Scene& scene, std::vector<BodyMotion>* bodies);
void ToGround(const Scene& scene, std::vector<BodyMotion>* bodies);  // and back
void ToLaboratory(const Scene& scene, PredictiveBands* bands);

}  // namespace pushid
