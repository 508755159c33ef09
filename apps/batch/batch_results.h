// apps: what a job left in its folder: status.json, model.json and, of a fold, scores.json.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "apps/batch/batch_jobs.h"
#include "apps/batch/job_status.h"
#include "ident/prediction/evaluation.h"
#include "ident/uncertainty/uncertainty.h"

namespace pushid {

struct JobResult {
  const BatchJob* job = nullptr;
  JobStatus status;
  std::map<std::string, double> parameters, errors;  // free ones, with standard errors
  std::map<std::string, EstimateStatus> statuses;
  std::map<std::string, double> data_shares;  // of their variance
  double cost = 0.0, solve_s = 0.0;
  bool settles = false;
  std::vector<std::string> warnings;
  std::optional<HipMetrics> held_out;  // of what was held out

  bool done() const { return status.state == JobState::kDone; }
};

std::string JobFolder(const BatchPlan& plan, const BatchJob& job);

// Never an error: damage costs the one job, which the next run does again.
JobResult ReadResult(const BatchPlan& plan, const BatchJob& job);

}  // namespace pushid
