// apps: the flags of pushid-push alone; those of sensors are in sensor_flags.h.
#pragma once

#include <string>

#include "apps/flags/sensor_flags.h"
#include "ident/push/push_estimation.h"

namespace pushid {

struct PushFlags {
  std::string id;      // the recording
  int person = 0;      // who is pushed
  std::string out;     // the push (CSV)
  SensorFlags sensor;  // what measured the push; without it, inverse dynamics

  // Inverse dynamics. A frame below zero is found from the motion.
  PushWindow window{-1, -1};
  int smoothing = 9;  // Savitzky-Golay window in frames; 0: none
};
Result<PushFlags> PushFlagsFromCommandLine();

}  // namespace pushid
