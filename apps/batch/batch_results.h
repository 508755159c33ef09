// apps: what a job left in its folder: status.json, model.json and, of a fold, scores.json.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/batch/batch_jobs.h"
#include "ident/figures/text_table.h"
#include "ident/uncertainty/uncertainty.h"

namespace pushid {

// status.json says how a job ended; it is written last and whole.
//
//   {"id": "...", "variant": "physics", "group": "X05", "replica": 0, "status": "failed",
//    "reason": "...", "commands": [["pushid-fit", ...], ...], "run": {"seconds": 1.5}}
enum class JobState {
  kDone,    // all its files can be read
  kFailed,  // it ended otherwise, or they cannot
  kOpen,    // it never ended
};
constexpr EnumNames<JobState, 3> Names(JobState) {
  return {{{"done", JobState::kDone}, {"failed", JobState::kFailed}, {"open", JobState::kOpen}}};
}

struct JobStatus {
  JobState state = JobState::kOpen;
  std::string reason;  // of a failure
  double seconds = 0.0;
};

MaybeError WriteJobStatus(const std::string& folder, const BatchJob& job, const JobStatus& status,
                          const std::vector<std::vector<std::string>>& commands);

// kOpen where the folder has no status.json.
Result<JobStatus> ReadJobStatus(const std::string& folder);

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
