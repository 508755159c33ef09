// apps: the flag that says what makes restored bodies fit.
#pragma once

#include "datasets/files/error.h"
#include "models/restoration/postprocess.h"

namespace pushid {

// What --postprocess lists.
Result<PostprocessOptions> PostprocessFromCommandLine();

}  // namespace pushid
