// ident: what forecasts are learned from: every fitted recording, forecast from several of its
// frames (recording_effect.h says what for).
#pragma once

#include <vector>

#include "ident/results/recording_effect.h"

namespace pushid {

// Sets blend_rate, widening and explained; the spread and the error scale must be known.
void LearnForecasts(const IdentifiedModel& model,
                    const std::vector<const PendulumRecording*>& recordings, int num_threads,
                    RecordingEffect* effect);

}  // namespace pushid
