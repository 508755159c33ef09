// apps: --observed.
#include <gflags/gflags.h>

#include "apps/flags/command_line.h"
#include "apps/flags/futures_flags.h"
#include "ident/prediction/evaluation.h"

DEFINE_int32(observed, 0,
             "number of observed frames before the predicted ones, including frame 0; without this "
             "flag, only frame 0");

DEFINE_choice(forecast, pushid::ForecastUse::kStack,
              "who forecasts after observed frames: stack (all together), physics (the rollout), "
              "input (a filter with an unknown force), kinematic (no model)");

namespace pushid {

ForecastUse ForecastUseFlag() {
  ForecastUse use = ForecastUse::kStack;
  ParseName("--forecast", FLAGS_forecast, &use);  // CheckObservedFlag has told of what is none
  return use;
}

int ObservedFrames() { return Given("observed") ? FLAGS_observed : 0; }

MaybeError CheckObservedFlag() {
  ForecastUse use;
  if (MaybeError error = ParseName("--forecast", FLAGS_forecast, &use)) return error;
  if (Given("forecast") && !Given("observed")) {
    return Error{"--forecast says who forecasts after observed frames: it needs --observed"};
  }
  return CheckObservedFlag({});
}

MaybeError CheckObservedFlag(const std::vector<PendulumRecording>& recordings) {
  if (!Given("observed")) return std::nullopt;
  return CheckObserved(recordings, FLAGS_observed);
}

MaybeError CheckObservedFlag(const std::vector<PendulumRecording>& recordings,
                             const IdentifiedModel& model) {
  if (!Given("observed")) return std::nullopt;
  if (MaybeError error = CheckLearnsFromFrames(model)) return error;
  return CheckObservedFlag(recordings);
}

}  // namespace pushid
