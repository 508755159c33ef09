// apps: the table of a batch: one row a job, with what it found or why it failed.
#pragma once

#include <string>
#include <vector>

#include "apps/batch/batch_results.h"

namespace pushid {

std::vector<JobResult> ReadResults(const BatchPlan& plan, const std::vector<BatchJob>& jobs);

// summary.csv (its columns: batch_columns.h), summary.json and summary.html in the plan's folder.
MaybeError WriteSummary(const BatchPlan& plan, const std::vector<JobResult>& rows);

// By variant: jobs done and failed, mean and spread over groups of each parameter; the bootstrap of
// each group where those are few; failures.
std::string SummaryText(const std::vector<JobResult>& rows);

}  // namespace pushid
