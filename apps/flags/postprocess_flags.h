// apps: --postprocess, corrections of restored bodies.
#pragma once

#include "apps/flags/command_line.h"
#include "models/restoration/postprocess.h"

DEFINE_string(postprocess, "fade,bones,feet",
              "corrections of restored bodies: fade (start at the first pose), bones (constant "
              "lengths), feet (standing feet do not slide), comma-separated; or none");

namespace pushid {

inline PostprocessOptions PostprocessFromCommandLine() {
  PostprocessOptions options;
  options.fade_residual = options.keep_bones = options.lock_feet = false;
  if (FLAGS_postprocess == "none") return options;
  for (const std::string& name : SplitList(FLAGS_postprocess)) {
    if (name == "fade") {
      options.fade_residual = true;
    } else if (name == "bones") {
      options.keep_bones = true;
    } else if (name == "feet") {
      options.lock_feet = true;
    } else {
      throw Error{"--postprocess names '" + name + "'; it must list fade, bones, feet, or be none"};
    }
  }
  return options;
}

}  // namespace pushid
