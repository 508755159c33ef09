// apps: the flags of pushid-path alone.
#pragma once

#include <string>
#include <vector>

#include "ident/forecasts/most_probable_path.h"

namespace pushid {

struct PathFlags {
  bool between = true;  // two ends; otherwise a recording is smoothed
  PathEnd from;
  std::vector<PathEnd> to;             // of which the most probable one is found
  std::vector<std::string> end_names;  // as they were given
  Body body;
  double fps = 60.0;
  int frames = 60;
  std::string id;        // of the recording that is smoothed
  std::string out;       // states and noise (CSV)
  std::string json_out;  // actions
};
Result<PathFlags> PathFlagsFromCommandLine();

}  // namespace pushid
