// apps: the flags that say what measured a push and how: one sensor by flags, several by a list.
#pragma once

#include <vector>

#include "datasets/sensors/sensor_choice.h"

namespace pushid {

struct SensorFlags {
  std::vector<SensorChoice> sensors;  // which push together; empty: none is given
  bool start_given = false;           // their clocks at frame 0 are not taken from the motion
  bool estimate_offset = false;       // of their clocks from the motion's
  double max_offset_s = 0.5;          // how far estimate_offset looks on either side
};
// Errors also for flags that contradict each other, or belong to a sensor where none is given.
Result<SensorFlags> SensorFlagsFromCommandLine();

// Whether --sensor or --sensors is given.
bool SensorGiven();

}  // namespace pushid
