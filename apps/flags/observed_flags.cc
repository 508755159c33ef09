// apps: --observed.
#include <gflags/gflags.h>

#include "apps/flags/command_line.h"
#include "apps/flags/futures_flags.h"
#include "ident/prediction/evaluation.h"

DEFINE_int32(observed, 0,
             "number of observed frames before the predicted ones, including frame 0; without this "
             "flag, only frame 0");

DEFINE_string(forecast, pushid::NameOf(pushid::ForecastUse::kBoth),
              "who forecasts after observed frames: physics (the rollout), input (a filter with an "
              "unknown force) or both");

namespace pushid {

ForecastUse ForecastUseFlag() {
  ForecastUse use = ForecastUse::kBoth;
  ParseName("--forecast", FLAGS_forecast, &use);  // CheckObservedFlag refuses other names
  return use;
}

int ObservedFrames() { return Given("observed") ? FLAGS_observed : 0; }

void CheckObservedFlag() {
  ForecastUse use;
  OrFail(ParseName("--forecast", FLAGS_forecast, &use));
  if (Given("forecast") && !Given("observed")) {
    throw Error{"--forecast needs --observed: it chooses who forecasts after observed frames"};
  }
  CheckObservedFlag({});
}

void CheckObservedFlag(const std::vector<PendulumRecording>& recordings) {
  if (!Given("observed")) return;
  OrFail(CheckObserved(recordings, FLAGS_observed));
}

void CheckObservedFlag(const std::vector<PendulumRecording>& recordings,
                       const IdentifiedModel& model) {
  if (!Given("observed")) return;
  OrFail(CheckLearnsFromFrames(model));
  CheckObservedFlag(recordings);
}

}  // namespace pushid
