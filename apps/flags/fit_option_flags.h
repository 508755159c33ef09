// apps: the flags that say what to fit and how: the rows of the option table
// (ident/parameters/option_table.h) as gflags; shared by pushid-fit and pushid-crossvalidate.
#pragma once

#include <cstdint>

#include "ident/fit/fit_setup.h"

namespace pushid {

// Flags that the command line gave, even with their defaults' values.
GivenOptions GivenFitFlags();

// The given flags over the preset's settings; once in a program. Errors also where a given flag
// acts on nothing.
FitSetup FitSetupFromFlags();

int NumThreads();
uint64_t Seed();

}  // namespace pushid
