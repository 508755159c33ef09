// First inputs of model-fuzz: models with every part that a model can have, without a fit.
#pragma once

#include <string>

#include "datasets/files/error.h"

namespace pushid {

MaybeError WriteModelSeeds(const std::string& folder);

}  // namespace pushid
