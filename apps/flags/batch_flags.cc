// apps: pushid-batch by flag.
#include "apps/flags/batch_flags.h"

#include <gflags/gflags.h>

#include <cstdio>

#include "apps/flags/command_line.h"

DEFINE_string(plan, "", "the plan (TOML); apps/README.md gives its keys");
DEFINE_bool(
    list, false,
    "only list the jobs (CSV): id, variant, group, replica, numbers of recordings fitted and "
    "held out, folder");
DEFINE_bool(dry_run, false, "only print the commands of the unfinished jobs");
DEFINE_int32(jobs, pushid::BatchFlags{}.jobs, "number of jobs run in parallel");
DEFINE_string(shard, "", "i/n: only every n-th job, starting with the i-th (from 1)");
DEFINE_string(job, "", "only the job with this id (or the start of its id)");
DEFINE_bool(resume, pushid::BatchFlags{}.resume,
            "skip finished jobs; false runs all jobs again and discards earlier results");
DEFINE_bool(keep_going, pushid::BatchFlags{}.keep_going, "continue after a failed job");
DEFINE_bool(summary, pushid::BatchFlags{}.summary,
            "write summary.csv, summary.json and summary.html; set to false for shards that run at "
            "the same time");
DEFINE_bool(gather, false, "run nothing; only write the summary of existing results");
DEFINE_double(time_limit, 0.0, "time limit of one job, s, instead of the plan's; 0: none");
DEFINE_int32(memory_limit, 0,
             "limit of one job's address space, MB, instead of the plan's; 0: none");

namespace pushid {
namespace {

MaybeError ReadShard(BatchFlags* flags) {
  if (FLAGS_shard.empty()) return std::nullopt;
  char rest = 0;
  int& i = flags->shard;
  int& n = flags->shards;
  if (std::sscanf(FLAGS_shard.c_str(), "%d/%d%c", &i, &n, &rest) == 2 && 1 <= i && i <= n) {
    return std::nullopt;
  }
  return Error{"--shard is '" + FLAGS_shard + "'; write i/n with 1 <= i <= n, as in 2/4"};
}

MaybeError ReadLimits(BatchFlags* flags) {
  if (Given("time_limit")) flags->time_limit_s = FLAGS_time_limit;
  if (Given("memory_limit")) flags->memory_limit_mb = FLAGS_memory_limit;
  if (!(flags->time_limit_s.value_or(0.0) >= 0.0)) {
    return Error{"--time_limit must be a number of seconds, 0 for none"};
  }
  if (flags->memory_limit_mb.value_or(0) < 0) {
    return Error{"--memory_limit must be a number of MB, 0 for none"};
  }
  return std::nullopt;
}

}  // namespace

Result<BatchFlags> BatchFlagsFromCommandLine() {
  if (MaybeError missing = Require("plan", FLAGS_plan, "name the TOML file of the batch")) {
    return *missing;
  }
  if (FLAGS_jobs < 1) return Error{"--jobs must be at least 1"};
  BatchFlags flags;
  flags.plan = FLAGS_plan;
  flags.action = FLAGS_list      ? BatchAction::kList
                 : FLAGS_dry_run ? BatchAction::kPrintCommands
                 : FLAGS_gather  ? BatchAction::kGather
                                 : BatchAction::kRun;
  flags.jobs = FLAGS_jobs;
  flags.job = FLAGS_job;
  flags.resume = FLAGS_resume;
  flags.keep_going = FLAGS_keep_going;
  flags.summary = FLAGS_summary;
  if (MaybeError error = ReadShard(&flags)) return *error;
  if (MaybeError error = ReadLimits(&flags)) return *error;
  return flags;
}

}  // namespace pushid
