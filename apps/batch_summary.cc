// apps: collecting a batch's results.
#include "apps/batch_summary.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "apps/app_support.h"
#include "datasets/atomic_file.h"
#include "datasets/json_file.h"
#include "datasets/number_text.h"
#include "ident/json_pieces.h"
#include "ident/report/document_files.h"
#include "ident/report/page.h"
#include "ident/text_table.h"

namespace pushid {
namespace {

constexpr size_t kMostRowsOnPage = 2000;

using Json = nlohmann::ordered_json;

std::vector<std::string> ParameterNames(const std::vector<JobResult>& rows) {
  std::vector<std::string> names;
  std::set<std::string> seen;
  for (const JobResult& row : rows) {
    for (const auto& [name, value] : row.parameters) {
      if (seen.insert(name).second) names.push_back(name);
    }
  }
  return names;
}

std::string Cell(const std::map<std::string, double>& values, const std::string& name) {
  const auto found = values.find(name);
  return found == values.end() ? "" : DoubleText(found->second);
}

std::string Joined(const std::vector<std::string>& sentences) {
  std::string text;
  for (const std::string& sentence : sentences) text += (text.empty() ? "" : "; ") + sentence;
  return text;
}

// Full precision, for summary.csv.
TextTable FullTable(const std::vector<JobResult>& rows) {
  const std::vector<std::string> names = ParameterNames(rows);
  std::vector<std::string> header = {"id", "variant", "group", "replica", "status", "reason"};
  header.insert(header.end(), names.begin(), names.end());
  for (const std::string& name : names) header.push_back(name + "_se");
  for (const char* name : {"cost", "settles", "held_out_hip_ade_m", "held_out_hip_fde_m",
                           "warnings", "solve_s", "seconds"}) {
    header.push_back(name);
  }
  TextTable table(header, std::vector<bool>(header.size(), true));
  for (const JobResult& row : rows) {
    const bool done = row.status == "done";
    std::vector<std::string> cells = {row.job->id,    row.job->variant,
                                      row.job->group, std::to_string(row.job->replica),
                                      row.status,     row.reason};
    for (const std::string& name : names) cells.push_back(Cell(row.parameters, name));
    for (const std::string& name : names) cells.push_back(Cell(row.errors, name));
    cells.push_back(done ? DoubleText(row.cost) : "");
    cells.push_back(done ? (row.settles ? "yes" : "no") : "");
    cells.push_back(row.hip_ade >= 0.0 ? DoubleText(row.hip_ade) : "");
    cells.push_back(row.hip_fde >= 0.0 ? DoubleText(row.hip_fde) : "");
    cells.push_back(Joined(row.warnings));
    cells.push_back(done ? DoubleText(row.solve_s) : "");
    cells.push_back(row.status == "open" ? "" : DoubleText(row.seconds));
    table.Add(cells);
  }
  return table;
}

Json SummaryJson(const BatchPlan& plan, const std::vector<JobResult>& rows) {
  Json jobs = Json::array();
  for (const JobResult& row : rows) {
    Json job = {{"id", row.job->id},       {"variant", row.job->variant},
                {"group", row.job->group}, {"replica", row.job->replica},
                {"status", row.status},    {"reason", row.reason}};
    if (row.status == "done") {
      for (const auto& [name, value] : row.parameters) {
        job["parameters"][name] = {{"value", NumberJson(value)},
                                   {"standard_error", NumberJson(row.errors.at(name))}};
      }
      job["cost"] = NumberJson(row.cost);
      job["settles"] = row.settles;
      if (!row.warnings.empty()) job["warnings"] = row.warnings;
      if (row.hip_ade >= 0.0) {
        job["held_out"] = {{"hipADE_m", row.hip_ade}, {"hipFDE_m", row.hip_fde}};
      }
    }
    job["run"] = {{"solve_s", row.solve_s}, {"seconds", row.seconds}};
    jobs.push_back(job);
  }
  return {{"plan", plan.path}, {"version", Version()}, {"jobs", jobs}};
}

struct VariantSummary {
  int done = 0, failed = 0, open = 0;
  std::map<std::string, std::vector<double>> values;
};

std::vector<std::pair<std::string, VariantSummary>> ByVariant(const std::vector<JobResult>& rows) {
  std::vector<std::pair<std::string, VariantSummary>> variants;
  for (const JobResult& row : rows) {
    auto at = std::find_if(variants.begin(), variants.end(), [&row](const auto& variant) {
      return variant.first == row.job->variant;
    });
    if (at == variants.end()) at = variants.insert(variants.end(), {row.job->variant, {}});
    ++(row.status == "done"   ? at->second.done
       : row.status == "open" ? at->second.open
                              : at->second.failed);
    for (const auto& [name, value] : row.parameters) at->second.values[name].push_back(value);
    if (row.hip_ade < 0.0) continue;
    at->second.values["held-out hipADE, m"].push_back(row.hip_ade);
    at->second.values["held-out hipFDE, m"].push_back(row.hip_fde);
  }
  return variants;
}

TextTable VariantTable(const std::vector<JobResult>& rows) {
  TextTable table({"variant", "jobs done", "failed", "open", "of each job", "mean", "std deviation",
                   "lowest", "highest"},
                  {true, false, false, false, true, false, false, false, false});
  for (const auto& [name, v] : ByVariant(rows)) {
    table.Add({name, std::to_string(v.done), std::to_string(v.failed), std::to_string(v.open)});
    for (const auto& [what, values] : v.values) {
      double sum = 0.0, squares = 0.0;
      for (double value : values) sum += value;
      const double n = static_cast<double>(values.size()), mean = sum / n;
      for (double value : values) squares += (value - mean) * (value - mean);
      const auto [low, high] = std::minmax_element(values.begin(), values.end());
      table.Add({"", "", "", "", what, Significant(mean),
                 values.size() > 1 ? Significant(std::sqrt(squares / (n - 1.0)), 3) : "-",
                 Significant(*low), Significant(*high)});
    }
  }
  return table;
}

TextTable FailureTable(const std::vector<JobResult>& rows) {
  TextTable table({"failed", "variant", "group", "replica", "reason"},
                  {true, true, true, false, true});
  for (const JobResult& row : rows) {
    if (row.status != "failed" || table.rows().size() > kMostRowsOnPage) continue;
    table.Add({row.job->id.substr(0, 8), row.job->variant, row.job->group,
               std::to_string(row.job->replica), row.reason});
  }
  return table;
}

// Rounded, for the page.
TextTable JobTable(const std::vector<JobResult>& rows) {
  const std::vector<std::string> names = ParameterNames(rows);
  std::vector<std::string> header = {"job", "variant", "group", "replica", "status"};
  header.insert(header.end(), names.begin(), names.end());
  header.insert(header.end(), {"settles", "held-out hipADE, m", "held-out hipFDE, m", "solve s",
                               "seconds", "warnings"});
  std::vector<bool> words(header.size(), false);
  std::fill(words.begin(), words.begin() + 3, true);
  words[4] = words.back() = true;
  TextTable table(header, words);
  for (const JobResult& row : rows) {
    if (table.rows().size() > kMostRowsOnPage) break;
    std::vector<std::string> cells = {row.job->id.substr(0, 8), row.job->variant, row.job->group,
                                      std::to_string(row.job->replica), row.status};
    for (const std::string& name : names) {
      const auto found = row.parameters.find(name);
      cells.push_back(found == row.parameters.end() ? ""
                                                    : Significant(found->second) + " +- " +
                                                          Significant(row.errors.at(name), 3));
    }
    const bool done = row.done();
    cells.push_back(done ? (row.settles ? "yes" : "no") : "");
    cells.push_back(row.hip_ade >= 0.0 ? Significant(row.hip_ade, 3) : "");
    cells.push_back(row.hip_fde >= 0.0 ? Significant(row.hip_fde, 3) : "");
    cells.push_back(done ? Significant(row.solve_s, 2) : "");
    cells.push_back(row.status == "open" ? "" : Significant(row.seconds, 2));
    cells.push_back(Joined(row.warnings));
    table.Add(cells);
  }
  return table;
}

Report PageOf(const BatchPlan& plan, const std::vector<JobResult>& rows) {
  Report report;
  report.title = "pushid: batch of " + std::to_string(rows.size()) + " jobs";
  report.subtitle = plan.path + ", recordings " + plan.manifest + ", pushid " + Version();
  ReportSection variants, failures, jobs;
  variants.id = "variants";
  variants.title = "Variants";
  variants.tables = {{"over all groups and replicas", VariantTable(rows)}};
  failures.id = "failures";
  failures.title = "Failures";
  const TextTable failed = FailureTable(rows);
  failures.paragraphs = {failed.rows().size() > 1 ? "Failed jobs are tried again by the next run."
                                                  : "None."};
  failures.tables = {{"", failed}};
  jobs.id = "jobs";
  jobs.title = "Jobs";
  if (rows.size() > kMostRowsOnPage) {
    jobs.paragraphs = {"The first " + std::to_string(kMostRowsOnPage) +
                       "; all of them are in summary.csv."};
  }
  jobs.tables = {{"", JobTable(rows)}};
  report.sections = {variants, failures, jobs};
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
  const TextTable failed = FailureTable(rows);
  return VariantTable(rows).ToString() + (failed.rows().size() > 1 ? "\n" + failed.ToString() : "");
}

}  // namespace pushid
