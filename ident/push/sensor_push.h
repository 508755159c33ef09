// ident: the push of a person from one force sensor, or from several that push together.
#pragma once

#include <string>
#include <vector>

#include "datasets/loading/pendulum_recording.h"
#include "datasets/sensors/sensor_choice.h"

namespace pushid {

struct SensorSetup {
  std::vector<SensorChoice> sensors;  // which push together
  bool start_given = false;           // their clocks at frame 0 are not taken from the motion
  bool estimate_offset = false;       // of their clocks from the motion's
  double max_offset_s = 0.5;          // how far estimate_offset looks on either side
};

struct SensorPush {
  Push push;
  std::string how;                    // for people
  std::vector<std::string> warnings;  // for stderr
};

// The sum of the sensors' pushes on a person; `recorded` is the recording as it was read.
Result<SensorPush> PushFromSensors(const SensorSetup& setup, const Recording& recorded,
                                   const PendulumRecording& recording, int person);

}  // namespace pushid
