// apps: the flags of pushid-evaluate alone.
#pragma once

#include <string>

#include "apps/flags/restoration_flags.h"

namespace pushid {

struct EvaluateFlags {
  std::string json_out;          // scores
  RestorationFlags restoration;  // whole bodies too
  std::string peer;              // folder of a peer beside the restoration
  bool per_recording = true;     // a line for every recording
};
Result<EvaluateFlags> EvaluateFlagsFromCommandLine();

}  // namespace pushid
