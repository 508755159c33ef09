// apps: the flags by which programs draw futures from a model with process noise.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/loading/pendulum_recording.h"
#include "ident/model/identified_model.h"

namespace pushid {

inline constexpr std::uint64_t kFuturesSeed = 1;  // of all draws

// --samples; 0: none are drawn.
int DrawnFutures();

// What is wrong with drawing from a model: no process noise, or frames that were seen.
void CheckDraws(const IdentifiedModel& model);

// Draws them and prints where everybody is at the end; nothing without --samples. num_frames: 0
// means as many as the recording has. Returns an exit code.
int PrintFutures(const IdentifiedModel& model, const PendulumRecording& recording, int num_frames);

// --observed, of every program that predicts recordings.

// How many first frames are seen; 0: none.
int ObservedFrames();

// Who forecasts then.
ForecastUse ForecastUseFlag();

// What is wrong with them, by themselves.
void CheckObservedFlag();
// For these recordings.
void CheckObservedFlag(const std::vector<PendulumRecording>& recordings);
// And this model.
void CheckObservedFlag(const std::vector<PendulumRecording>& recordings,
                       const IdentifiedModel& model);

}  // namespace pushid
