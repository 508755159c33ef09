// apps: the flags of pushid-animate alone.
#pragma once

#include <string>

#include "apps/flags/restoration_flags.h"

namespace pushid {

struct AnimateFlags {
  std::string id;                // the recording to show
  RestorationFlags restoration;  // rigid bodies where none is given
  std::string out;               // page (HTML); empty: none
  std::string strip_out;         // strip of poses (SVG); empty: none
  int poses = 7;                 // of the strip
  std::string explain;           // a person whose forces are told in words, or auto; empty: nobody
  bool recorded = true;          // beside the predicted bodies
  bool bodies_asked = false;     // by --restoration; otherwise only where the skeleton has them
};
Result<AnimateFlags> AnimateFlagsFromCommandLine();

}  // namespace pushid
