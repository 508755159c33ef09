// apps: what is wrong or without effect among the flags of a fit.
#pragma once

#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "ident/parameters/fit_options.h"

namespace pushid {

// Numbers out of their range, by flag.
MaybeError CheckFitNumbers();

// Flags that are taken but do nothing, or not what they seem to.
std::vector<std::string> FlagWarnings(const FitOptions& options);

}  // namespace pushid
