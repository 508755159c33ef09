// apps: --observed.
#include "apps/flags/observed_flags.h"

#include <gflags/gflags.h>

#include "apps/flags/command_line.h"
#include "ident/prediction/evaluation.h"

DEFINE_int32(observed, 0,
             "number of observed frames before the predicted ones, including frame 0; without this "
             "flag, only frame 0");

namespace pushid {

int ObservedFrames() { return Given("observed") ? FLAGS_observed : 0; }

MaybeError CheckObservedFlag() { return CheckObservedFlag({}); }

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
