// apps: what a job left in its folder: status.json, model.json and, of a fold, scores.json.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "apps/batch/batch_jobs.h"
#include "apps/batch/job_status.h"
#include "ident/figures/text_table.h"
#include "ident/uncertainty/uncertainty.h"

namespace pushid {

struct HeldOutScore {
  Metric metric;
  double value = 0.0;  // mean over what was held out
};

struct JobResult {
  const BatchJob* job = nullptr;
  JobStatus status;
  std::map<std::string, double> parameters, errors;  // free ones, with standard errors
  std::map<std::string, EstimateStatus> statuses;
  std::map<std::string, double> data_shares;  // of their variance
  double cost = 0.0, solve_s = 0.0;
  bool settles = false;
  std::vector<std::string> warnings;
  // Of the restored bodies, or of the hips where nothing is restored; empty where nothing was held
  // out.
  std::vector<HeldOutScore> held_out;

  // Null where there is no such score.
  const double* HeldOut(const Metric& metric) const;

  bool done() const { return status.state == JobState::kDone; }
};

std::string JobFolder(const BatchPlan& plan, const BatchJob& job);

// Never an error: damage costs the one job, which the next run does again.
JobResult ReadResult(const BatchPlan& plan, const BatchJob& job);

// All that some job was scored by.
std::vector<Metric> HeldOutMetrics(const std::vector<JobResult>& rows);

}  // namespace pushid
