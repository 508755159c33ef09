// apps: the flags that say what to fit and how; shared by pushid-fit and pushid-crossvalidate.
#pragma once

#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "ident/parameters/fit_options.h"

namespace pushid {

// Flags over the preset's settings.
Result<FitOptions> FitOptionsFromFlags();

// The same with a space-separated list of other flags ("--self_force=linear --push_tail=none") on
// top: a candidate for pushid-crossvalidate. The flags are put back afterwards.
Result<FitOptions> FitOptionsWith(const std::string& extra_flags);

int NumThreads();

}  // namespace pushid
