// apps: the flags by which an executable samples a generator of diffusion.
#pragma once

#include <vector>

#include "datasets/files/error.h"
#include "models/generators/diffusion_generator.h"

namespace pushid {

// Errors name the flag.
Result<DiffusionGeneratorOptions> DiffusionOptionsFromCommandLine();

// These flags.
std::vector<const char*> DiffusionFlagNames();

}  // namespace pushid
