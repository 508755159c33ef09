// apps: the flags that say what to fit and how: the rows of the option table
// (ident/parameters/option_table.h) as gflags; shared by pushid-fit and pushid-crossvalidate.
#pragma once

#include <cstdint>

#include "apps/flags/flag_table.h"
#include "datasets/files/error.h"
#include "ident/checks/model_checks.h"
#include "ident/fit/fit_setup.h"

namespace pushid {

// Those that the command line gave, even with their defaults' values.
GivenOptions GivenFitFlags();

// The given flags over the preset's settings; once in a program. Errors also where a given flag
// acts on nothing.
FitSetup FitSetupFromFlags();

int NumThreads();
uint64_t Seed();

// The flags that question a finished model: of pushid-check, and until version 0.4 of
// pushid-fit too.

// gflags wants a value after --profile; alone it means all.
void AllowBareProfile(int argc, char** argv);

// Errors also for flags without the one that they belong to.
ModelChecks ModelChecksFromCommandLine(uint64_t seed, int num_threads);

// Those that moved from pushid-fit to pushid-check.
MovedFlags MovedCheckFlags();

// AddChecks with a progress line, and the message that Ctrl-C prints about --bootstrap_file.
void AddFlaggedChecks(const std::vector<PendulumRecording>& recordings, const ModelChecks& checks,
                      FittedModel* model);

}  // namespace pushid
