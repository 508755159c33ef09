// apps: what a batch's jobs found, in tables for people; numbers rounded.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "apps/batch/batch_results.h"
#include "ident/figures/text_table.h"

namespace pushid {

inline constexpr size_t kMostRowsOnPage = 2000;

// Counts of each variant, and how its estimates (replica 0) differ between groups.
TextTable VariantTable(const std::vector<JobResult>& rows);

// Errors of what was held out, a row a group and variant: means over those folds alone that all
// variants have, so that none is judged by easier ones, and the difference to the first variant
// with its standard error over folds. Says which folds are missing.
TextTable HeldOutTable(const std::vector<JobResult>& rows);

// A parameter of one group over the bootstrap replicas of that group.
struct BootstrapSpread {
  const BatchJob* job;  // replica 0
  std::string parameter;
  double estimate;
  int replicas;
  double standard_error, lower95, upper95;
};
// Groups of at least two replicas.
std::vector<BootstrapSpread> SpreadOverReplicas(const std::vector<JobResult>& rows);
TextTable BootstrapTable(const std::vector<JobResult>& rows);

// Each warning once, with how many jobs it is of.
TextTable WarningTable(const std::vector<JobResult>& rows);

TextTable FailureTable(const std::vector<JobResult>& rows);
TextTable JobTable(const std::vector<JobResult>& rows);

}  // namespace pushid
