// apps: the flags of pushid-fit alone.
#pragma once

#include <string>

#include "datasets/files/error.h"

namespace pushid {

struct FitFlags {
  std::string model_out;         // empty: the model is not kept
  int resample = 0;              // replica of a bootstrap; 0: the recordings as they are
  std::string body_restoration;  // folder of the restoration for --body_weight; empty: none
  bool check = false;            // only check the flags
  bool list_parameters = false;  // only print the glossary of every parameter
};

Result<FitFlags> FitFlagsFromCommandLine();

}  // namespace pushid
