// apps: the flags of pushid-push.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ident/push/push_estimation.h"
#include "ident/push/push_from_sensor.h"

namespace pushid {

struct PushFlags {
  std::vector<std::string> ids;  // the recordings
  int person = 0;                // who is pushed
  std::string out;               // the push (CSV); {id} in it stands for the recording's id
  bool into_manifest = false;    // the entry too
  bool overwrite = false;        // what is there already
  SensorSetup sensor;            // what measured the push; without it, inverse dynamics

  // Inverse dynamics. A frame below zero is found from the motion.
  PushWindow window{-1, -1};
  int smoothing = 9;                                // Savitzky-Golay window in frames; 0: none
  std::optional<InitialVelocity> initial_velocity;  // as PushEstimationOptions has it

  std::string OutOf(const std::string& id) const;
  SensorSetup SensorOf(const std::string& id) const;  // {id} in the names of its files alike
};
PushFlags PushFlagsFromCommandLine();

}  // namespace pushid
