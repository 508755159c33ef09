// apps: pushid-push --sensor: one push from the sensors that push together.
#pragma once

#include <string>
#include <vector>

#include "apps/flags/push_flags.h"
#include "datasets/loading/pendulum_recording.h"

namespace pushid {

struct SensorPush {
  Push push;
  std::string how;                    // for people
  std::vector<std::string> warnings;  // for stderr
};

// The sum of the sensors' pushes on a person; `recorded` is the recording as it was read.
Result<SensorPush> PushFromSensors(const SensorFlags& flags, const Recording& recorded,
                                   const PendulumRecording& recording, int person);

}  // namespace pushid
