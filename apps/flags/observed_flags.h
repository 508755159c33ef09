// apps: --observed, of every program that predicts recordings.
#pragma once

#include <vector>

#include "datasets/files/error.h"
#include "datasets/loading/pendulum_recording.h"
#include "ident/model/identified_model.h"

namespace pushid {

// How many first frames are seen; 0: none.
int ObservedFrames();

// Who forecasts then.
ForecastUse ForecastUseFlag();

// What is wrong with them, by themselves.
MaybeError CheckObservedFlag();
// For these recordings.
MaybeError CheckObservedFlag(const std::vector<PendulumRecording>& recordings);
// And this model.
MaybeError CheckObservedFlag(const std::vector<PendulumRecording>& recordings,
                             const IdentifiedModel& model);

}  // namespace pushid
