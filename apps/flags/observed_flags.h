// apps: --observed, of every program that predicts recordings.
#pragma once

#include <gflags/gflags.h>

#include <vector>

#include "apps/flags/command_line.h"
#include "datasets/loading/pendulum_recording.h"
#include "ident/model/identified_model.h"
#include "ident/prediction/evaluation.h"

DEFINE_int32(observed, 0,
             "number of observed frames before the predicted ones, including frame 0; without this "
             "flag, only frame 0");

DEFINE_string(forecast, pushid::NameOf(pushid::ForecastUse::kBoth),
              "who forecasts after observed frames: physics (the rollout), input (a filter with an "
              "unknown force) or both");

namespace pushid {

// --forecast: who forecasts after observed frames.
inline ForecastUse ForecastUseFlag() {
  ForecastUse use = ForecastUse::kBoth;
  ParseName("--forecast", FLAGS_forecast, &use);  // CheckObservedFlag refuses other names
  return use;
}

inline int ObservedFrames() { return Given("observed") ? FLAGS_observed : 0; }

// Throw where --observed and --forecast do not go together, with these recordings, or with this
// model.
inline void CheckObservedFlag(const std::vector<PendulumRecording>& recordings) {
  if (!Given("observed")) return;
  OrFail(CheckObserved(recordings, FLAGS_observed));
}

inline void CheckObservedFlag() {
  ForecastUse use;
  OrFail(ParseName("--forecast", FLAGS_forecast, &use));
  if (Given("forecast") && !Given("observed")) {
    throw Error{"--forecast needs --observed: it chooses who forecasts after observed frames"};
  }
  CheckObservedFlag({});
}

inline void CheckObservedFlag(const std::vector<PendulumRecording>& recordings,
                              const IdentifiedModel& model) {
  if (!Given("observed")) return;
  OrFail(CheckLearnsFromFrames(model));
  CheckObservedFlag(recordings);
}

}  // namespace pushid
