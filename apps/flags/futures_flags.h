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

// Throws where the model has no process noise to draw from, or frames were observed.
void CheckDraws(const IdentifiedModel& model);

// Draws them and prints where everybody is at the end; nothing without --samples. num_frames: 0
// means as many as the recording has. Returns an exit code.
int PrintFutures(const IdentifiedModel& model, const PendulumRecording& recording, int num_frames);

// --observed, of every program that predicts recordings.

int ObservedFrames();

// --forecast: who forecasts after observed frames.
ForecastUse ForecastUseFlag();

// Throw where --observed and --forecast do not go together, with these recordings, or with this
// model.
void CheckObservedFlag();
void CheckObservedFlag(const std::vector<PendulumRecording>& recordings);
void CheckObservedFlag(const std::vector<PendulumRecording>& recordings,
                       const IdentifiedModel& model);

}  // namespace pushid
