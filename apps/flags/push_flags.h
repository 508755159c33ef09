// apps: the flags of pushid-push.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "datasets/sensors/sensor_choice.h"
#include "ident/push/push_estimation.h"

namespace pushid {

// What measured a push and how: one sensor by flags, several by a list.
struct SensorFlags {
  std::vector<SensorChoice> sensors;  // which push together; empty: none is given
  bool start_given = false;           // their clocks at frame 0 are not taken from the motion
  bool estimate_offset = false;       // of their clocks from the motion's
  double max_offset_s = 0.5;          // how far estimate_offset looks on either side
};
struct PushFlags {
  std::vector<std::string> ids;  // the recordings
  int person = 0;                // who is pushed
  std::string out;               // the push (CSV); {id} in it stands for the recording's id
  bool into_manifest = false;    // the entry too
  bool overwrite = false;        // what is there already
  SensorFlags sensor;            // what measured the push; without it, inverse dynamics

  // Inverse dynamics. A frame below zero is found from the motion.
  PushWindow window{-1, -1};
  int smoothing = 9;                                // Savitzky-Golay window in frames; 0: none
  std::optional<InitialVelocity> initial_velocity;  // as PushEstimationOptions has it

  std::string OutOf(const std::string& id) const;
  SensorFlags SensorOf(const std::string& id) const;  // {id} in the names of its files alike
};
Result<PushFlags> PushFlagsFromCommandLine();

}  // namespace pushid
