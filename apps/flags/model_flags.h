// apps: the flags by which an executable takes an identified model.
#pragma once

#include <gflags/gflags.h>

#include "datasets/files/error.h"
#include "ident/results/fit_result.h"
#include "ident/results/identified_model.h"

DECLARE_string(model);

namespace pushid {

// The model of --model with the values of --set.
Result<IdentifiedModel> LoadFlaggedModel();

}  // namespace pushid
