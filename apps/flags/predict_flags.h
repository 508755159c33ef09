// apps: the flags of pushid-predict alone.
#pragma once

#include <string>

#include "apps/flags/restoration_flags.h"

namespace pushid {

struct PredictFlags {
  std::string id;                // the recording whose first frame and push are taken
  std::string out;               // trajectory (CSV), or bodies (BVH, glTF)
  int frames = 0;                // to predict; 0: as many as the recording has
  RestorationFlags restoration;  // whole bodies too
  std::string joints_out;        // of bodies: joint positions (CSV); empty: none
  std::string json_out;          // of bodies: joint positions (JSON); empty: none

  bool whole_recording() const { return frames == 0; }
  bool out_is_bodies() const;
};
Result<PredictFlags> PredictFlagsFromCommandLine();

}  // namespace pushid
