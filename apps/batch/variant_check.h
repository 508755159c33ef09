// apps: the flags of a plan's variants, checked by the programs themselves before any job starts: a
// flag misspelt would fail in every job, one after the other.
#pragma once

#include <string>
#include <vector>

#include "apps/batch/batch_jobs.h"

namespace pushid {

// Of the variants that the jobs are of. Errors: what the program says, with the plan's line; there
// is no program that trains.
MaybeError CheckVariants(const BatchPlan& plan, const std::vector<BatchJob>& jobs,
                         const std::string& bin);

}  // namespace pushid
