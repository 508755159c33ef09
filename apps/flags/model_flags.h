// apps: the flags by which an executable takes an identified model.
#pragma once

#include <string>

#include "datasets/files/error.h"
#include "ident/model/fitted_model.h"
#include "ident/model/identified_model.h"

namespace pushid {

struct ModelFlags {
  std::string file;  // that pushid-fit --model_out wrote
  std::string set;   // what-if values, name=value comma-separated
};
ModelFlags ModelFlagsFromCommandLine();

// Whether --model is given; `why` says what it must name, or what needs it.
MaybeError RequireModel(const std::string& why = "give a file that pushid-fit --model_out wrote");

// The model of --model with the values of --set.
Result<IdentifiedModel> LoadFlaggedModel();

}  // namespace pushid
