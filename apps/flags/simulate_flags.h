// apps: the flags of pushid-simulate for synthetic recordings; those of formations are in
// formation_flags.h.
#pragma once

#include <string>

#include "datasets/synthetic/synthetic_recordings.h"

namespace pushid {

struct SimulateFlags {
  std::string out;              // folder to write
  SyntheticOptions recordings;  // all but the truth: model and parameters
};
// Errors also for flags that need --formation.
Result<SimulateFlags> SimulateFlagsFromCommandLine();

}  // namespace pushid
