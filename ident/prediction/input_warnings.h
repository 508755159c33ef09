// ident: what is odd about recordings that a model is to predict.
#pragma once

#include <string>
#include <vector>

#include "datasets/loading/pendulum_recording.h"
#include "ident/results/identified_model.h"

namespace pushid {

// Recordings in other units than they say, people who stand together under a model without
// contact, pushes beyond those of the fit. Sentences for GroupedWarnings.
std::vector<std::string> InputWarnings(const IdentifiedModel& model,
                                       const std::vector<PendulumRecording>& recordings);

}  // namespace pushid
