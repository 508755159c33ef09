// apps: from a plan to jobs. A job's id is the hash of all that decides its result - the contents
// of its recordings and of the files its flags name, its flags, its replica and the version of the
// programs - so the same job keeps its id in another order, folder or plan, and a changed file
// makes new jobs of those it touches.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/batch/batch_plan.h"
#include "datasets/manifest/manifest.h"

namespace pushid {

struct BatchJob {
  std::string id;       // 32 hexadecimal digits
  std::string variant;  // by name
  std::string group;    // "X05", "row_1", "all"; of a fold "X05 fold 2 of 4"
  std::string folded;   // the group that the fold is of: "X05"
  int replica = 0;      // 0: the recordings as they are
  std::vector<std::string> recordings, held_out;  // ids
  std::vector<std::string> fit_flags;             // of pushid-fit, without outputs and recordings
  // Of pushid-train-restoration, likewise; without them nothing is restored.
  std::optional<std::vector<std::string>> restoration_flags;
};

// In a fixed order: variants as in the plan, groups as in the manifest, folds, replicas. Errors: of
// the manifest, a group with fewer recordings than folds, files that cannot be read.
Result<std::vector<BatchJob>> ExpandPlan(const BatchPlan& plan, const Manifest& manifest);

// What to run, one after the other: pushid-fit and, of a fold, pushid-evaluate on what was held
// out. folder: of the job; bin: where the programs are.
std::vector<std::vector<std::string>> JobCommands(const BatchJob& job, const BatchPlan& plan,
                                                  const std::string& folder,
                                                  const std::string& bin);

// The part i of n (from 1) of the jobs, every n-th one. Jobs of the same id, of variants with the
// same flags, are in one part.
std::vector<BatchJob> Shard(const std::vector<BatchJob>& jobs, int i, int n);

}  // namespace pushid
