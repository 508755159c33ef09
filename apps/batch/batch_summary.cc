// apps: collecting a batch's results.
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "apps/batch/batch.h"
#include "apps/support/app_support.h"
#include "datasets/files/atomic_file.h"
#include "datasets/files/json_file.h"
#include "datasets/files/number_text.h"
#include "ident/figures/text_table.h"
#include "ident/parameters/json_archive.h"
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
  TextTable table(header);
  for (const JobResult& row : rows) {
    std::vector<std::string> cells;
    for (const JobColumn& column : columns) cells.push_back(column.cell(row).exact);
    table.Add(cells);
  }
  return table;
}

Json SummaryJson(const BatchPlan& plan, const std::vector<JobResult>& rows) {
  const std::vector<JobColumn> columns = JobColumns(rows);
  Json jobs = Json::array();
  for (const JobResult& row : rows) {
    Json job;
    for (const JobColumn& column : columns) {
      const Json value = column.cell(row).json;
      if (!value.is_null()) job[Json::json_pointer(column.place)] = value;
    }
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
  return {{"schema", "pushid-summary/1"},
          {"plan", plan.path},
          {"version", Version()},
          {"bootstrap", bootstrap},
          {"jobs", jobs}};
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

namespace {

JobCell Words(const std::string& text) { return {text, text, {}, text}; }

JobCell Number(double value, int digits) {
  return {DoubleText(value), Rounded(value, digits), value, NumberJson(value)};
}

JobCell Nothing() { return {}; }

std::string Joined(const std::vector<std::string>& sentences) {
  std::string text;
  for (const std::string& sentence : sentences) text += (text.empty() ? "" : "; ") + sentence;
  return text;
}

// A value that is not the data's own says so.
std::string EstimateText(double value, double error, EstimateStatus status) {
  const std::string text = Rounded(value, 4);
  return (std::isfinite(error) ? text + " +- " + Rounded(error, 3) : text) +
         (status == EstimateStatus::kIdentified ? "" : " (" + NameOf(status) + ")");
}

// "hipADE" -> "hip_ade", "relative_MPJPE" -> "relative_mpjpe"
std::string LowerCase(const std::string& name) {
  std::string text;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const auto c = static_cast<unsigned char>(name[i]);
    const bool begins = i > 0 && std::isupper(c) && name[i - 1] != '_' &&
                        !std::isupper(static_cast<unsigned char>(name[i - 1]));
    text += (begins ? "_" : "") + std::string(1, static_cast<char>(std::tolower(c)));
  }
  return text;
}

// In the order in which jobs first have them.
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

// A name may have a slash.
std::string Place(const char* folder, const std::string& name, const char* rest = "") {
  return (Json::json_pointer(folder) / name).to_string() + rest;
}

JobColumn ParameterColumn(const std::string& name) {
  return {
      name, Place("/parameters", name, "/value"), name, false, true, [name](const JobResult& row) {
        const auto found = row.parameters.find(name);
        if (found == row.parameters.end()) return Nothing();
        JobCell cell = Number(found->second, 4);
        cell.shown = EstimateText(found->second, row.errors.at(name), row.statuses.at(name));
        return cell;
      }};
}

// On the page error and status stand beside the value. of: the member of a result that has them.
template <typename Value>
JobColumn BesideParameter(const std::string& name, const char* ending, const char* key,
                          std::map<std::string, Value> JobResult::*of) {
  constexpr bool kWords = !std::is_same_v<Value, double>;
  return {name + ending,
          Place("/parameters", name, key),
          "",
          kWords,
          false,
          [name, of](const JobResult& row) {
            const auto found = (row.*of).find(name);
            if (found == (row.*of).end()) return Nothing();
            if constexpr (kWords)
              return Words(NameOf(found->second));
            else
              return Number(found->second, 3);
          }};
}

JobColumn HeldOutColumn(const Metric& metric) {
  return {"held_out_" + LowerCase(metric.name) + "_" + metric.unit,
          Place("/held_out", metric.Key()),
          std::string("held-out ") + metric.name + ", " + metric.unit,
          false,
          false,
          [metric](const JobResult& row) {
            const double* const value = row.HeldOut(metric);
            return value != nullptr ? Number(*value, 3) : Nothing();
          }};
}

}  // namespace

std::vector<JobColumn> JobColumns(const std::vector<JobResult>& rows) {
  using Row = const JobResult&;
  std::vector<JobColumn> columns = {
      {"id", "/id", "job", true, false,
       [](Row r) {
         return JobCell{r.job->id, r.job->id.substr(0, 8), {}, r.job->id};
       }},
      {"variant", "/variant", "variant", true, false, [](Row r) { return Words(r.job->variant); }},
      {"group", "/group", "group", true, false, [](Row r) { return Words(r.job->group); }},
      {"replica", "/replica", "replica", false, false,
       [](Row r) {
         const std::string text = std::to_string(r.job->replica);
         return JobCell{text, text, {}, r.job->replica};
       }},
      {"status", "/status", "status", true, false,
       [](Row r) { return Words(NameOf(r.status.state)); }},
      {"reason", "/reason", "", true, false, [](Row r) { return Words(r.status.reason); }},
  };
  const auto add = [&columns](JobColumn column) { columns.push_back(std::move(column)); };
  const std::vector<std::string> names = ParameterNames(rows);
  for (const std::string& name : names) add(ParameterColumn(name));
  for (const std::string& name : names) {
    add(BesideParameter(name, "_se", "/standard_error", &JobResult::errors));
  }
  for (const std::string& name : names) {
    add(BesideParameter(name, "_status", "/status", &JobResult::statuses));
  }
  for (const std::string& name : names) {
    add(BesideParameter(name, "_data_share", "/data_share", &JobResult::data_shares));
  }
  add({"cost", "/cost", "", false, false,
       [](Row r) { return r.done() ? Number(r.cost, 4) : Nothing(); }});
  add({"settles", "/settles", "settles", false, false, [](Row r) {
         if (!r.done()) return Nothing();
         const std::string text = r.settles ? "yes" : "no";
         return JobCell{text, text, {}, r.settles};
       }});
  for (const Metric& metric : HeldOutMetrics(rows)) add(HeldOutColumn(metric));
  add({"warnings", "/warnings", "warnings", false, false, [](Row r) {
         if (r.warnings.empty()) return Nothing();
         return JobCell{Joined(r.warnings), std::to_string(r.warnings.size()), {}, r.warnings};
       }});
  add({"solve_s", "/run/solve_s", "solve s", false, false, [](Row r) {
         JobCell cell = r.done() ? Number(r.solve_s, 2) : Nothing();
         cell.json = r.solve_s;
         return cell;
       }});
  add({"seconds", "/run/seconds", "seconds", false, false, [](Row r) {
         JobCell cell = r.status.state == JobState::kOpen ? Nothing() : Number(r.status.seconds, 2);
         cell.json = r.status.seconds;
         return cell;
       }});
  return columns;
}

}  // namespace pushid
