// apps: the flags of a plan's variants, checked by pushid-fit itself before any job starts: a flag
// misspelt would fail in every job, one after the other.
#pragma once

#include <string>
#include <vector>

#include "apps/batch/batch_jobs.h"

namespace pushid {

// Of the variants that the jobs are of. Errors: what pushid-fit says, with the plan's line.
MaybeError CheckVariants(const BatchPlan& plan, const std::vector<BatchJob>& jobs,
                         const std::string& bin);

}  // namespace pushid
