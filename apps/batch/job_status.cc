// apps: status.json, written and read.
#include "apps/batch/job_status.h"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "datasets/files/json_fields.h"
#include "datasets/files/json_file.h"

namespace pushid {
namespace {

std::string StatusFile(const std::string& folder) { return folder + "/status.json"; }

}  // namespace

std::string NameOf(JobState state) {
  switch (state) {
    case JobState::kDone:
      return "done";
    case JobState::kFailed:
      return "failed";
    case JobState::kOpen:
      break;
  }
  return "open";
}

std::optional<JobState> JobStateFromName(std::string_view name) {
  for (JobState state : {JobState::kDone, JobState::kFailed, JobState::kOpen}) {
    if (name == NameOf(state)) return state;
  }
  return std::nullopt;
}

MaybeError WriteJobStatus(const std::string& folder, const BatchJob& job, const JobStatus& status,
                          const std::vector<std::vector<std::string>>& commands) {
  const nlohmann::ordered_json json = {{"id", job.id},
                                       {"variant", job.variant},
                                       {"group", job.group},
                                       {"replica", job.replica},
                                       {"status", NameOf(status.state)},
                                       {"reason", status.reason},
                                       {"commands", commands},
                                       {"run", {{"seconds", status.seconds}}}};
  return WriteJson(StatusFile(folder), json);
}

Result<JobStatus> ReadJobStatus(const std::string& folder) {
  JobStatus status;
  std::error_code ignored;
  if (!std::filesystem::exists(StatusFile(folder), ignored)) return status;
  const Result<JsonDocument> read = ReadJsonDocument(StatusFile(folder));
  if (!read.ok()) return read.error();
  const JsonDocument& document = read.value();
  JsonFields fields(document, document.content, "", "status");
  fields.Require("status", "done or failed");
  status.state =
      fields.Choice("status", &JobStateFromName, JobState::kFailed, "done, failed or open");
  status.reason = fields.Text("reason", "why the job failed");
  if (fields.Require("run", "an object with the seconds")) {
    JsonFields run(document, fields.At("run"), fields.Pointer("run"), "status, run");
    status.seconds = run.Number("seconds", "how long the job took");
    fields.Add(run);
  }
  if (fields.failed()) return *fields.error();
  return status;
}

}  // namespace pushid
