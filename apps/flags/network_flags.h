// apps: the flags of what a fit learns on top of the physics, as part of fit_flags.h.
#pragma once

#include <cstdint>

#include "datasets/files/error.h"
#include "ident/parameters/fit_options.h"

namespace pushid {

// What they say of the self force, the rod and their training; networks begin at that seed.
MaybeError ReadNetworkFlags(uint64_t seed, FitOptions* options);

// What asks for a network where there is none, or for more than it can do; the options complete.
MaybeError CheckNetworkFlags(const FitOptions& options);

}  // namespace pushid
