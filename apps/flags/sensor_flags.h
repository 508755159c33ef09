// apps: the flags that say what measured a push and how: one sensor by flags, several by a list.
#pragma once

#include <string>
#include <vector>

#include "datasets/loading/pendulum_recording.h"
#include "datasets/sensors/sensor_choice.h"
#include "ident/push/push_from_sensor.h"

namespace pushid {

// Whether --sensor or --sensors is given.
bool SensorGiven();

// Flags that contradict each other, or belong to a sensor where none is given.
MaybeError CheckSensorFlags();

struct SensorPush {
  Push push;
  std::string how;                    // for people
  std::vector<std::string> warnings;  // for stderr
};

// The sum of the sensors' pushes on a person.
// `recorded` is the recording as it was read.
Result<SensorPush> PushFromSensors(const Recording& recorded, const PendulumRecording& recording,
                                   int person);

}  // namespace pushid
