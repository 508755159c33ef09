// apps: what a job left in its folder: status.json, model.json and, of a fold, scores.json.
#pragma once

#include <map>
#include <string>

#include "apps/batch/batch_jobs.h"

namespace pushid {

struct JobResult {
  const BatchJob* job = nullptr;
  // done: all its files can be read; failed: it ended otherwise, or they cannot; open: it never
  // ended.
  std::string status;
  std::string reason;                                // of a failure
  std::map<std::string, double> parameters, errors;  // free ones, with standard errors
  double cost = 0.0, solve_s = 0.0, seconds = 0.0;
  bool settles = false;
  std::vector<std::string> warnings;
  double hip_ade = -1.0, hip_fde = -1.0;  // of what was held out; negative: nothing was

  bool done() const { return status == "done"; }
};

std::string JobFolder(const BatchPlan& plan, const BatchJob& job);

// Never an error: damage costs the one job, which the next run does again.
JobResult ReadResult(const BatchPlan& plan, const BatchJob& job);

}  // namespace pushid
