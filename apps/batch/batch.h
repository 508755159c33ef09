// apps: pushid-batch: its plan, a TOML file whose keys apps/README.md lists, the plan's jobs, and
// the table of what they found.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "datasets/files/json_file.h"
#include "datasets/manifest/manifest.h"
#include "ident/prediction/evaluation.h"
#include "ident/uncertainty/uncertainty.h"

namespace pushid {

struct BatchVariant {
  std::string name;
  std::vector<std::string> flags;  // of pushid-fit, with paths as the programs can open them
  // Flags of pushid-train-restoration; without them no bodies are restored.
  std::optional<std::vector<std::string>> restoration;
  int line = 0, restoration_line = 0;  // of the plan
};

struct BatchPlan {
  std::string path;      // of the plan
  std::string manifest;  // as the programs can open it
  std::string setting = "all";
  std::vector<std::string> ids, leave_out;
  std::string group_by = "none";
  int folds = 0, bootstrap = 0;
  uint64_t seed = 1;
  double time_limit_s = 0.0;
  std::vector<BatchVariant> variants;
  std::string dir;
  std::map<std::string, int> lines;  // of the keys of its tables

  // An error about the plan's value under `key` that follows from more than the plan.
  Error ErrorAt(const std::string& key, const Error& error) const;
};

// Errors: file:line, what is wrong: TOML syntax, unknown or missing keys, wrong types, values out
// of range, two variants of one name, flags that the batch sets itself.
Result<BatchPlan> ReadPlan(const std::string& path);

// Jobs of a plan. A job's id is the hash of all that decides its result (contents of its recordings
// and of the files its flags name, flags, replica, version of the programs), so the same job keeps
// its id in another order, folder or plan, and a changed file makes new jobs of those it touches.

struct BatchJob {
  std::string id;       // 32 hexadecimal digits
  std::string variant;  // by name
  std::string group;    // "X05", "row_1", "all"; of a fold "X05 fold 2 of 4"
  std::string folded;   // the group that the fold is of: "X05"
  int replica = 0;      // 0: the recordings as they are
  std::vector<std::string> recordings, held_out;  // ids
  std::vector<std::string> fit_flags;             // of pushid-fit, without outputs and recordings
  // Flags of pushid-train-restoration, likewise; without them nothing is restored.
  std::optional<std::vector<std::string>> restoration_flags;
};

// The order is fixed: variants as in the plan, groups as in the manifest, folds, replicas. Errors:
// a group with fewer recordings than folds, files that cannot be read.
std::vector<BatchJob> ExpandPlan(const BatchPlan& plan, const Manifest& manifest);

std::string JobFolder(const BatchPlan& plan, const BatchJob& job);

// The commands of a job, one after the other: pushid-fit, the training of a restoration, and for a
// fold pushid-evaluate on what was held out. All write into the job's folder.
std::vector<std::vector<std::string>> JobCommands(const BatchPlan& plan, const BatchJob& job);

// Part i of n (from 1) of the jobs: every n-th one. Jobs of the same id (variants with the same
// flags) are in one part.
std::vector<BatchJob> Shard(const std::vector<BatchJob>& jobs, int i, int n);

// Files that a job left in its folder: status.json, model.json and, for a fold, scores.json.

enum class JobState {
  kDone,    // all its files can be read
  kFailed,  // it ended otherwise, or they cannot
  kOpen,    // it never ended
};
constexpr EnumNames<JobState, 3> Names(JobState) {
  return {{{"done", JobState::kDone}, {"failed", JobState::kFailed}, {"open", JobState::kOpen}}};
}

struct JobResult {
  const BatchJob* job = nullptr;
  JobState state = JobState::kOpen;
  std::string reason;  // of a failure
  double seconds = 0.0;
  std::map<std::string, Estimate> parameters;  // free ones
  double cost = 0.0, solve_s = 0.0;
  bool settles = false;
  std::vector<std::string> warnings;
  // Mean scores over what was held out: of the restored bodies, or of the hips where nothing is
  // restored.
  std::vector<std::pair<MetricId, double>> held_out;

  // The score, or null where there is none.
  const double* HeldOut(MetricId metric) const;

  bool done() const { return state == JobState::kDone; }
};

// There are no errors: damage costs this job, which the next run does again.
JobResult ReadResult(const BatchPlan& plan, const BatchJob& job);

// Running a batch's jobs, several at a time, each in a folder and in processes of its own.
//
// A job has ended when jobs/<id>/status.json stands; it is written last and whole. Everything else
// in a job's folder may be half-written by a kill and is made again. Who works on a job holds the
// lock of its folder, so that batches may run in one output folder at the same time.

struct BatchOutcome {
  int skipped = 0, done = 0, failed = 0, left = 0;
  double seconds_left = 0.0;  // by what the jobs so far took
  int elsewhere = 0;          // left to another process that was at work on them
  bool interrupted = false;  // Ctrl-C or a polite kill: started jobs were ended, and will be redone
  std::vector<std::string> unrecorded;  // why jobs failed whose folders could not take a status
};

// at_once: jobs that run at a time. Errors: nothing can be written below the output folder; nothing
// is lost by trying again. A failure in one job's folder costs that job.
Result<BatchOutcome> RunBatch(const BatchPlan& plan, const std::vector<BatchJob>& jobs, int at_once,
                              const std::function<void(const BatchOutcome&)>& progress);

// The value of a key in a list in the order of first appearance; a new key is appended with an
// empty value.
template <typename Value>
Value& ValueOf(const std::string& key, std::vector<std::pair<std::string, Value>>* list) {
  for (auto& [known, value] : *list) {
    if (known == key) return value;
  }
  return list->emplace_back(key, Value()).second;
}

// The table of a batch: one row for each job, with what it found or why it failed.

std::vector<JobResult> ReadResults(const BatchPlan& plan, const std::vector<BatchJob>& jobs);

// summary.csv and summary.json in the plan's folder.
void WriteSummary(const BatchPlan& plan, const std::vector<JobResult>& rows);

// Tables by variant (jobs done and failed, mean and spread over groups of each parameter), of the
// bootstrap where its groups are few, and of failures.
std::string SummaryText(const std::vector<JobResult>& rows);

}  // namespace pushid
