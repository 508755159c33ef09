// apps: --observed, of every program that predicts recordings.
#pragma once

#include "apps/flags/command_line.h"
#include "ident/prediction/evaluation.h"

DEFINE_int32(observed, 0,
             "number of observed frames before the predicted ones, including frame 0; without this "
             "flag, only frame 0");

DEFINE_string(forecast, pushid::NameOf(pushid::ForecastUse::kBoth),
              "who forecasts after observed frames: physics (the rollout), input (a filter with an "
              "unknown force) or both");

namespace pushid {

inline ForecastUse ForecastUseFlag() {
  ForecastUse use;
  OrFail(ParseName("--forecast", FLAGS_forecast, &use));
  return use;
}

inline int ObservedFrames() { return Given("observed") ? FLAGS_observed : 0; }

// Throws where --observed and --forecast do not go together, with these recordings, or with this
// model.
inline void CheckObservedFlag(const std::vector<PendulumRecording>& recordings = {},
                              const IdentifiedModel* model = nullptr) {
  ForecastUseFlag();  // refuses other names
  if (Given("forecast") && !Given("observed")) {
    throw Error{"--forecast needs --observed: it chooses who forecasts after observed frames"};
  }
  if (!Given("observed")) return;
  if (model != nullptr) OrFail(CheckLearnsFromFrames(*model));
  OrFail(CheckObserved(recordings, FLAGS_observed));
}

}  // namespace pushid
