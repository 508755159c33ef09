// apps: the plan of pushid-batch, a TOML file:
//
//   [data]
//   recordings = "M/manifest.json"   # relative to the plan
//   setting = "single"               # as --setting; default all
//   ids = ["a", "b"]                 # only these; default all of the setting
//   leave_out = ["c"]                # not these of them
//
//   [jobs]
//   group_by = "subject"             # recording, subject, a label (setting, ...) or none (default)
//   folds = 0                        # k: each group in k folds, held-out recordings scored
//   bootstrap = 0                    # replicas of each group, besides the recordings as they are
//   seed = 1
//   time_limit_s = 0.0               # of one job; 0: none
//   memory_limit_mb = 0              # of one job; 0: none
//
//   [[variant]]                      # one or more
//   name = "physics"
//   flags = ["--self_force=none"]    # any flag of pushid-fit; files relative to the plan
//   restoration = ["--kind=window"]  # flags of pushid-train-restoration; absent: none is trained
//
//   [output]
//   dir = "out"                      # relative to the plan
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "datasets/files/error.h"

namespace pushid {

struct BatchVariant {
  std::string name;
  std::vector<std::string> flags;  // of pushid-fit, with paths as the programs can open them
  // Of pushid-train-restoration; where there are none, no bodies are restored.
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
  int memory_limit_mb = 0;
  std::vector<BatchVariant> variants;
  std::string dir;
  std::map<std::string, int> lines;  // of the keys of [data] and [jobs]

  // An error about what the plan says under `key`, where more than the plan shows that it is wrong.
  Error ErrorAt(const std::string& key, const Error& error) const;
};

// The file that a variant's flag reads ("--self_from=model.json"), or nothing.
std::string FileOfFlag(const std::string& flag);

// Errors: file:line, what is wrong: TOML syntax, unknown or missing keys, wrong types, values out
// of range, two variants of one name, flags that the batch sets itself.
Result<BatchPlan> ReadPlan(const std::string& path);

}  // namespace pushid
