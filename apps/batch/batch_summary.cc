// apps: collecting a batch's results.
#include "apps/batch/batch_summary.h"

#include <nlohmann/json.hpp>

#include "apps/batch/batch_columns.h"
#include "apps/batch/batch_tables.h"
#include "apps/support/app_support.h"
#include "datasets/files/atomic_file.h"
#include "datasets/files/json_file.h"
#include "datasets/files/number_text.h"
#include "ident/figures/text_table.h"
#include "ident/model/json_pieces.h"
#include "ident/report/page/document.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;

constexpr size_t kMostRowsInText = 40;

// Full precision, for summary.csv.
TextTable FullTable(const std::vector<JobResult>& rows) {
  const std::vector<JobColumn> columns = JobColumns(rows);
  std::vector<std::string> header;
  for (const JobColumn& column : columns) header.push_back(column.name);
  TextTable table(header, AllWords(header.size()));
  for (const JobResult& row : rows) {
    std::vector<std::string> cells;
    for (const JobColumn& column : columns) cells.push_back(column.cell(row).exact);
    table.Add(cells);
  }
  return table;
}

Json SummaryJson(const BatchPlan& plan, const std::vector<JobResult>& rows) {
  Json jobs = Json::array();
  for (const JobResult& row : rows) {
    Json job = {{"id", row.job->id},
                {"variant", row.job->variant},
                {"group", row.job->group},
                {"replica", row.job->replica},
                {"status", NameOf(row.status.state)},
                {"reason", row.status.reason}};
    if (row.done()) {
      for (const auto& [name, value] : row.parameters) {
        job["parameters"][name] = {{"value", NumberJson(value)},
                                   {"standard_error", NumberJson(row.errors.at(name))},
                                   {"status", NameOf(row.statuses.at(name))},
                                   {"data_share", NumberJson(row.data_shares.at(name))}};
      }
      job["cost"] = NumberJson(row.cost);
      job["settles"] = row.settles;
      if (!row.warnings.empty()) job["warnings"] = row.warnings;
      for (const HeldOutScore& score : row.held_out) {
        job["held_out"][score.metric.Key()] = NumberJson(score.value);
      }
    }
    job["run"] = {{"solve_s", row.solve_s}, {"seconds", row.status.seconds}};
    jobs.push_back(job);
  }
  Json bootstrap = Json::array();
  for (const BootstrapSpread& s : SpreadOverReplicas(rows)) {
    bootstrap.push_back({{"variant", s.job->variant},
                         {"group", s.job->group},
                         {"parameter", s.parameter},
                         {"estimate", NumberJson(s.estimate)},
                         {"replicas", s.replicas},
                         {"standard_error", NumberJson(s.standard_error)},
                         {"interval_95", {NumberJson(s.lower95), NumberJson(s.upper95)}}});
  }
  return {{"plan", plan.path}, {"version", Version()}, {"bootstrap", bootstrap}, {"jobs", jobs}};
}

Report PageOf(const BatchPlan& plan, const std::vector<JobResult>& rows) {
  Report report;
  report.title = "pushid: batch of " + std::to_string(rows.size()) + " jobs";
  report.subtitle = plan.path + ", recordings " + plan.manifest + ", pushid " + Version();
  ReportSection variants, failures, warnings, jobs;
  variants.id = "variants";
  variants.title = "Variants";
  variants.tables = {{"estimates over groups", VariantTable(rows)}};
  const TextTable bootstrap = BootstrapTable(rows), warned = WarningTable(rows);
  const TextTable held_out = HeldOutTable(rows);
  if (held_out.rows().size() > 1) {
    variants.tables.push_back({"errors on held-out recordings", held_out});
  }
  if (bootstrap.rows().size() > 1) {
    variants.tables.push_back({"bootstrap: spread over the replicas of each group", bootstrap});
  }
  failures.id = "failures";
  failures.title = "Failures";
  const TextTable failed = FailureTable(rows);
  failures.paragraphs = {failed.rows().size() > 1 ? "The next run retries failed jobs." : "None."};
  failures.tables = {{"", failed}};
  warnings.id = "warnings";
  warnings.title = "Warnings";
  if (warned.rows().size() == 1) warnings.paragraphs = {"None."};
  warnings.tables = {{"", warned}};
  jobs.id = "jobs";
  jobs.title = "Jobs";
  if (rows.size() > kMostRowsOnPage) {
    jobs.paragraphs = {"The first " + std::to_string(kMostRowsOnPage) +
                       "; summary.csv has all of them."};
  }
  jobs.tables = {{"", JobTable(rows)}};
  report.sections = {variants, failures, warnings, jobs};
  return report;
}

}  // namespace

std::vector<JobResult> ReadResults(const BatchPlan& plan, const std::vector<BatchJob>& jobs) {
  std::vector<JobResult> rows;
  for (const BatchJob& job : jobs) rows.push_back(ReadResult(plan, job));
  return rows;
}

MaybeError WriteSummary(const BatchPlan& plan, const std::vector<JobResult>& rows) {
  if (MaybeError error = WriteFileAtomically(plan.dir + "/summary.csv", CsvOf(FullTable(rows)))) {
    return error;
  }
  if (MaybeError error = WriteJson(plan.dir + "/summary.json", SummaryJson(plan, rows))) {
    return error;
  }
  return WriteFileAtomically(plan.dir + "/summary.html", ToPage(PageOf(plan, rows)));
}

std::string SummaryText(const std::vector<JobResult>& rows) {
  const TextTable bootstrap = BootstrapTable(rows), failed = FailureTable(rows);
  const TextTable held_out = HeldOutTable(rows);
  std::string text = VariantTable(rows).ToString();
  if (held_out.rows().size() > 1) text += "\n" + held_out.ToString();
  if (bootstrap.rows().size() > 1 && bootstrap.rows().size() <= kMostRowsInText) {
    text += "\n" + bootstrap.ToString();
  }
  return text + (failed.rows().size() > 1 ? "\n" + failed.ToString() : "");
}

}  // namespace pushid
