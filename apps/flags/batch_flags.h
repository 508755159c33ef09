// apps: the flags of pushid-batch.
#pragma once

#include <optional>
#include <string>

#include "datasets/files/error.h"

namespace pushid {

// What to do with the jobs; of several, the first of this list is done.
enum class BatchAction { kList, kPrintCommands, kGather, kRun };

struct BatchFlags {
  std::string plan;  // TOML file
  BatchAction action = BatchAction::kRun;
  int jobs = 1;               // at a time
  int shard = 1, shards = 1;  // only every `shards`-th job, starting with this one, from 1
  std::string job;            // only jobs whose id begins so; empty: all
  bool resume = true;         // skip jobs that are done
  bool keep_going = true;     // after a job that failed
  bool summary = true;        // write the tables of all jobs
  // Instead of the plan's, for one job; 0: none.
  std::optional<double> time_limit_s;
  std::optional<int> memory_limit_mb;
};
Result<BatchFlags> BatchFlagsFromCommandLine();

}  // namespace pushid
