// apps: status.json, which says how a job of a batch ended; it is written last and whole.
//
//   {"id": "...", "variant": "physics", "group": "X05", "replica": 0, "status": "failed",
//    "reason": "...", "commands": [["pushid-fit", ...], ...], "run": {"seconds": 1.5}}
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/batch/batch_jobs.h"

namespace pushid {

enum class JobState {
  kDone,    // all its files can be read
  kFailed,  // it ended otherwise, or they cannot
  kOpen,    // it never ended
};
std::string NameOf(JobState state);  // "done", "failed", "open"
std::optional<JobState> JobStateFromName(std::string_view name);

struct JobStatus {
  JobState state = JobState::kOpen;
  std::string reason;  // of a failure
  double seconds = 0.0;
};

MaybeError WriteJobStatus(const std::string& folder, const BatchJob& job, const JobStatus& status,
                          const std::vector<std::vector<std::string>>& commands);

// kOpen where the folder has no status.json.
Result<JobStatus> ReadJobStatus(const std::string& folder);

}  // namespace pushid
