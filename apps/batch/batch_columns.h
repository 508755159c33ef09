// apps: the columns of a batch's table. A new one is a row in batch_columns.cc: summary.csv, the
// page and the terminal take name and cell from there.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "apps/batch/batch_results.h"

namespace pushid {

struct JobCell {
  std::string exact;  // in summary.csv
  std::string shown;  // to people: rounded or shortened
  // Of a number to be summarized over groups (JobColumn::over_groups).
  std::optional<double> number{};
};

struct JobColumn {
  std::string name;   // in summary.csv
  std::string title;  // on the page; empty: only in summary.csv
  bool words;         // to the left
  bool over_groups;   // the variants' table has its mean and spread over groups
  std::function<JobCell(const JobResult&)> cell;
};

// In the order of summary.csv.
std::vector<JobColumn> JobColumns(const std::vector<JobResult>& rows);

}  // namespace pushid
