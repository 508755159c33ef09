// ident: what forecasts are learned from: every fitted recording, forecast from several of its
// frames (recording_effect.h says what for).
#pragma once

#include <vector>

#include "ident/fit/recording_effect.h"
#include "ident/fit/recording_filter.h"

namespace pushid {

// A recording and its filter, which has seen frame 0 alone.
struct RecordingToForecast {
  const PendulumRecording* recording;
  RecordingFilter filter;
};

// Sets blend_rate, widening and explained; the spread and the error scale must be known.
void LearnForecasts(const IdentifiedModel& model, std::vector<RecordingToForecast> recordings,
                    int num_threads, RecordingEffect* effect);

}  // namespace pushid
