// apps: the table of a batch: one row a job, with what it found or why it failed.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "apps/batch_run.h"

namespace pushid {

struct SummaryRow {
  const BatchJob* job = nullptr;
  std::string status;  // done, failed or open
  std::string reason;
  std::map<std::string, double> parameters, errors;  // free ones, with standard errors
  double cost = 0.0, solve_s = 0.0, seconds = 0.0;
  bool settles = false;
  double hip_ade = -1.0, hip_fde = -1.0;  // of what was held out; negative: nothing was
};

// Reads what the jobs wrote. A job whose files cannot be read is failed, with the reason.
std::vector<SummaryRow> CollectRows(const BatchPlan& plan, const std::vector<BatchJob>& jobs);

// summary.csv, summary.json and summary.html in the plan's folder. CSV columns:
// id,variant,group,replica,status,reason,<parameter>...,<parameter>_se...,cost,settles,
// held_out_hip_ade_m,held_out_hip_fde_m,solve_s,seconds
MaybeError WriteSummary(const BatchPlan& plan, const std::vector<SummaryRow>& rows);

// By variant: jobs done and failed, mean and spread over groups and replicas of each parameter.
std::string SummaryText(const std::vector<SummaryRow>& rows);

}  // namespace pushid
