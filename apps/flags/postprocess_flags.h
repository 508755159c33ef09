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
  const std::map<std::string, bool*> corrections = {{"fade", &options.fade_residual},
                                                    {"bones", &options.keep_bones},
                                                    {"feet", &options.lock_feet}};
  for (const std::string& name : SplitList(FLAGS_postprocess)) {
    if (corrections.count(name) == 0) {
      throw Error{"--postprocess names '" + name + "'; it must list fade, bones, feet, or be none"};
    }
    *corrections.at(name) = true;
  }
  return options;
}

}  // namespace pushid
