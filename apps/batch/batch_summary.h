// apps: the table of a batch: one row a job, with what it found or why it failed.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/batch/batch_results.h"

namespace pushid {

// A column of the table. A new one is a row in JobColumns: summary.csv, summary.json, the page and
// the terminal take name, place and cell from there.
struct JobCell {
  std::string exact{};  // in summary.csv
  std::string shown{};  // to people: rounded or shortened
  // Of a number to be summarized over groups (JobColumn::over_groups).
  std::optional<double> number{};
  nlohmann::ordered_json json{};  // null: not in summary.json
};

struct JobColumn {
  std::string name;   // in summary.csv
  std::string place;  // in a job of summary.json: "/run/seconds"
  std::string title;  // on the page; empty: only in the files
  bool words;         // to the left
  bool over_groups;   // the variants' table has its mean and spread over groups
  std::function<JobCell(const JobResult&)> cell;
};

// In the order of summary.csv.
std::vector<JobColumn> JobColumns(const std::vector<JobResult>& rows);

std::vector<JobResult> ReadResults(const BatchPlan& plan, const std::vector<BatchJob>& jobs);

// summary.csv, summary.json and summary.html in the plan's folder.
MaybeError WriteSummary(const BatchPlan& plan, const std::vector<JobResult>& rows);

// By variant: jobs done and failed, mean and spread over groups of each parameter; the bootstrap of
// each group where those are few; failures.
std::string SummaryText(const std::vector<JobResult>& rows);

}  // namespace pushid
