// apps: running a batch's jobs, several at a time, each in a folder and in processes of its own.
//
// A job has ended when jobs/<id>/status.json stands; it is written last and whole. Everything else
// in a job's folder may be half-written by a kill and is made again. Who works on a job holds the
// lock of its folder, so that batches may run in one output folder at the same time.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "apps/batch/batch_results.h"

namespace pushid {

struct BatchRunOptions {
  int jobs = 1;             // at a time
  bool resume = true;       // skip those that are done; failed ones are tried again
  bool keep_going = true;   // after a failure
  double time_limit_s = 0;  // of one job; 0: none
  int memory_limit_mb = 0;
  std::string bin;  // where the programs are
};

struct BatchProgress {
  int done = 0, failed = 0, left = 0;
  double seconds_left = 0.0;  // by what the jobs so far took
};

struct BatchOutcome {
  int skipped = 0, done = 0, failed = 0;
  int elsewhere = 0;         // left to another process that was at work on them
  bool interrupted = false;  // Ctrl-C or a polite kill: started jobs were ended, and will be redone
  bool stopped = false;      // by the first failure
  std::vector<std::string> unrecorded;  // why jobs failed whose folders could not take a status
};

// Errors: nothing can be written below the output folder; nothing is lost by trying again. What
// hits one job's folder costs that job.
Result<BatchOutcome> RunBatch(const BatchPlan& plan, const std::vector<BatchJob>& jobs,
                              const BatchRunOptions& options,
                              const std::function<void(const BatchProgress&)>& progress);

}  // namespace pushid
