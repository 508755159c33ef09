// apps: the flags that question a finished model: of pushid-check, and until version 0.4 of
// pushid-fit too.
#pragma once

#include <cstdint>

#include "apps/flags/flag_table.h"
#include "ident/checks/model_checks.h"

namespace pushid {

// gflags wants a value after --profile; alone it means all.
void AllowBareProfile(int argc, char** argv);

// Errors also for flags without the one that they belong to.
Result<ModelChecks> ModelChecksFromCommandLine(uint64_t seed, int num_threads);

// Those that moved from pushid-fit to pushid-check.
MovedFlags MovedCheckFlags();

// AddChecks with a progress line, and the message that Ctrl-C prints about --bootstrap_file.
MaybeError AddFlaggedChecks(const std::vector<PendulumRecording>& recordings,
                            const ModelChecks& checks, FittedModel* model);

}  // namespace pushid
