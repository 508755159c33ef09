// apps: what a batch found, in files and in tables for people.
#include <cctype>
#include <set>

#include "apps/batch/batch.h"
#include "apps/flags/command_line.h"
#include "ident/parameters/json_archive.h"
#include "ident/problem/statistics.h"
#include "ident/report/document.h"
#include "ident/uncertainty/bootstrap.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;

constexpr size_t kMostRowsInText = 40, kMostRowsOnPage = 2000;

// A column of the table. A new one is a row in JobColumns: summary.csv, summary.json, the page and
// the terminal take name, place and cell from there.
struct JobCell {
  std::string exact{};            // in summary.csv
  std::string shown{};            // to people: rounded or shortened
  nlohmann::ordered_json json{};  // null: not in summary.json
};

struct JobColumn {
  std::string name;   // in summary.csv
  std::string place;  // in a job of summary.json: "/run/seconds"
  std::string title;  // on the page; empty: only in the files
  bool words;         // to the left
  std::function<JobCell(const JobResult&)> cell;
};

template <typename T>
void AddOnce(const T& one, std::vector<T>* all) {
  if (std::find(all->begin(), all->end(), one) == all->end()) all->push_back(one);
}

// All metrics by which some job was scored.
MetricList HeldOutMetrics(const std::vector<JobResult>& rows) {
  MetricList metrics;
  for (const JobResult& row : rows) {
    for (const auto& [metric, value] : row.held_out) AddOnce(metric, &metrics);
  }
  return metrics;
}

JobCell Words(const std::string& text) { return {text, text, text}; }

JobCell Number(double value, int digits) {
  return {DoubleText(value), Rounded(value, digits), NumberJson(value)};
}

JobCell Nothing() { return {}; }

// A value with its error and, unless the data identify it, its status.
std::string EstimateText(const Estimate& e) {
  const double of = e.interval().standard_error;
  const std::string text = Rounded(e.value, 4), error = Rounded(of, 3);
  return (std::isfinite(of) ? text + " +- " + error : text) +
         (e.status == EstimateStatus::kIdentified ? "" : " (" + NameOf(e.status) + ")");
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

// A name may have a slash.
std::string Place(const char* folder, const std::string& name, const char* rest = "") {
  return (Json::json_pointer(folder) / name).to_string() + rest;
}

// The columns in the order of summary.csv.
std::vector<JobColumn> JobColumns(const std::vector<JobResult>& rows) {
  using Row = const JobResult&;
  std::vector<JobColumn> columns = {
      {"id", "/id", "job", true,
       [](Row r) {
         return JobCell{r.job->id, r.job->id.substr(0, 8), r.job->id};
       }},
      {"variant", "/variant", "variant", true, [](Row r) { return Words(r.job->variant); }},
      {"group", "/group", "group", true, [](Row r) { return Words(r.job->group); }},
      {"replica", "/replica", "replica", false,
       [](Row r) {
         const std::string text = std::to_string(r.job->replica);
         return JobCell{text, text, r.job->replica};
       }},
      {"status", "/status", "status", true, [](Row r) { return Words(NameOf(r.state)); }},
      {"reason", "/reason", "", true, [](Row r) { return Words(r.reason); }},
  };
  const auto add = [&columns](JobColumn column) { columns.push_back(std::move(column)); };
  std::vector<std::string> names;  // in the order in which jobs first have them
  for (const JobResult& row : rows) {
    for (const auto& [name, value] : row.parameters) AddOnce(name, &names);
  }
  const auto of_parameters = [&](const char* ending, const char* key, bool words,
                                 JobCell (*cell)(const Estimate&)) {
    const bool value = *ending == '\0';  // on the page error and status stand beside it
    for (const std::string& name : names) {
      add({name + ending, Place("/parameters", name, key), value ? name : "", words,
           [name, cell](Row r) {
             const auto found = r.parameters.find(name);
             return found == r.parameters.end() ? Nothing() : cell(found->second);
           }});
    }
  };
  of_parameters("", "/value", false, [](const Estimate& e) {
    JobCell cell = Number(e.value, 4);
    cell.shown = EstimateText(e);
    return cell;
  });
  of_parameters("_se", "/standard_error", false,
                [](const Estimate& e) { return Number(e.standard_error, 3); });
  of_parameters("_status", "/status", true,
                [](const Estimate& e) { return Words(NameOf(e.status)); });
  of_parameters("_data_share", "/data_share", false,
                [](const Estimate& e) { return Number(e.shares.data, 3); });
  add({"cost", "/cost", "", false, [](Row r) { return r.done() ? Number(r.cost, 4) : Nothing(); }});
  add({"settles", "/settles", "settles", false, [](Row r) {
         if (!r.done()) return Nothing();
         const std::string text = r.settles ? "yes" : "no";
         return JobCell{text, text, r.settles};
       }});
  for (MetricId id : HeldOutMetrics(rows)) {
    const Metric& metric = kMetrics[id];
    add({"held_out_" + LowerCase(metric.name) + "_" + metric.unit, Place("/held_out", metric.Key()),
         std::string("held-out ") + metric.name + ", " + metric.unit, false, [id](Row r) {
           const double* const value = r.HeldOut(id);
           return value != nullptr ? Number(*value, 3) : Nothing();
         }});
  }
  add({"warnings", "/warnings", "warnings", false, [](Row r) {
         if (r.warnings.empty()) return Nothing();
         return JobCell{Joined(r.warnings, "; "), std::to_string(r.warnings.size()), r.warnings};
       }});
  add({"solve_s", "/run/solve_s", "solve s", false, [](Row r) {
         JobCell cell = r.done() ? Number(r.solve_s, 2) : Nothing();
         cell.json = r.solve_s;
         return cell;
       }});
  add({"seconds", "/run/seconds", "seconds", false, [](Row r) {
         JobCell cell = r.state == JobState::kOpen ? Nothing() : Number(r.seconds, 2);
         cell.json = r.seconds;
         return cell;
       }});
  return columns;
}

// The folds of one group: what each variant scored on each.
struct FoldScores {
  std::vector<std::string> variants, folds;                                // in the plan's order
  std::map<std::pair<std::string, std::string>, const JobResult*> scores;  // by variant and fold

  bool Has(const std::string& variant, const std::string& fold) const {
    return scores.count({variant, fold}) > 0;
  }
  std::vector<std::string> FoldsOfAll() const {
    std::vector<std::string> of_all;
    for (const std::string& fold : folds) {
      const bool all = std::all_of(variants.begin(), variants.end(),
                                   [&](const std::string& v) { return Has(v, fold); });
      if (all) of_all.push_back(fold);
    }
    return of_all;
  }
};

std::vector<std::pair<std::string, FoldScores>> ByGroup(const std::vector<JobResult>& rows) {
  std::vector<std::pair<std::string, FoldScores>> groups;
  for (const JobResult& row : rows) {
    if (row.job->held_out.empty() || row.job->replica > 0) continue;
    FoldScores& group = ValueOf(row.job->folded, &groups);
    AddOnce(row.job->variant, &group.variants);
    AddOnce(row.job->group, &group.folds);
    if (row.done() && !row.held_out.empty()) {
      group.scores[{row.job->variant, row.job->group}] = &row;
    }
  }
  return groups;
}

std::vector<std::string> HeldOutRow(const std::string& group, const std::string& variant,
                                    const FoldScores& of, const MetricList& metrics) {
  const std::vector<std::string> compared = of.FoldsOfAll();
  std::string missing;
  for (const std::string& fold : of.folds) {
    // "X05 fold 2 of 4": the group stands in the row already.
    if (!of.Has(variant, fold))
      missing += (missing.empty() ? "" : ", ") + fold.substr(group.size() + 1);
  }
  std::vector<std::string> cells = {
      group, variant, std::to_string(compared.size()) + " of " + std::to_string(of.folds.size())};
  for (MetricId metric : metrics) {
    std::vector<double> values, differences;
    for (const std::string& fold : compared) {
      const double* const value = of.scores.at({variant, fold})->HeldOut(metric);
      const double* const first = of.scores.at({of.variants[0], fold})->HeldOut(metric);
      if (value != nullptr) values.push_back(*value);
      if (value != nullptr && first != nullptr) differences.push_back(*value - *first);
    }
    cells.push_back(values.empty() ? "-" : Rounded(MeanOf(values).mean, 3));
    const bool compares = variant != of.variants[0] && differences.size() > 1;
    const MeanAndError mean = compares ? MeanOf(differences) : MeanAndError{};
    cells.push_back(compares ? Rounded(mean.mean, 3) + " +- " + Rounded(mean.error, 2) : "-");
  }
  cells.push_back(missing.empty() ? "-" : missing);
  return cells;
}

// Errors on held-out recordings, a row for each group and variant: means over the folds that all
// variants have, so that none is judged by easier ones, and the difference from the first variant
// with its standard error over folds; and which folds are missing.
TextTable HeldOutTable(const std::vector<JobResult>& rows) {
  std::vector<std::string> header = {"group", "variant", ">folds compared"};
  const MetricList metrics = HeldOutMetrics(rows);
  for (MetricId id : metrics) {
    const Metric& metric = kMetrics[id];
    header.push_back(std::string(">held-out ") + metric.name + ", " + metric.unit);
    header.push_back(">minus the first variant");
  }
  header.push_back("folds missing");
  TextTable table(header);
  for (const auto& [group, scores] : ByGroup(rows)) {
    for (const std::string& variant : scores.variants) {
      table.Add(HeldOutRow(group, variant, scores, metrics));
    }
  }
  return table;
}

// The standard deviation is that of a sample.
std::pair<double, double> MeanAndDeviation(const std::vector<double>& values) {
  double sum = 0.0, squares = 0.0;
  for (double value : values) sum += value;
  const double n = static_cast<double>(values.size()), mean = sum / n;
  for (double value : values) squares += (value - mean) * (value - mean);
  return {mean, std::sqrt(squares / (n - 1.0))};
}

// Counts of each variant, and how its estimates (replica 0) differ between groups.
TextTable VariantTable(const std::vector<JobResult>& rows) {
  struct Variant {
    std::map<JobState, int> jobs;
    std::map<std::string, std::vector<double>> values;
  };
  std::vector<std::pair<std::string, Variant>> variants;
  for (const JobResult& row : rows) {
    Variant& variant = ValueOf(row.job->variant, &variants);
    ++variant.jobs[row.state];
    if (row.job->replica > 0) continue;
    for (const auto& [name, e] : row.parameters) variant.values[name].push_back(e.value);
  }
  TextTable table({"variant", ">jobs done", ">failed", ">open", "over groups", ">mean",
                   ">std deviation", ">lowest", ">highest"});
  for (auto& [name, variant] : variants) {
    std::vector<std::string> counts = {name};
    for (JobState state : {JobState::kDone, JobState::kFailed, JobState::kOpen}) {
      counts.push_back(std::to_string(variant.jobs[state]));
    }
    table.Add(counts);
    for (const auto& [what, values] : variant.values) {
      const auto [mean, deviation] = MeanAndDeviation(values);
      const auto [low, high] = std::minmax_element(values.begin(), values.end());
      table.Add({"", "", "", "", what, Rounded(mean, 4),
                 values.size() > 1 ? Rounded(deviation, 3) : "-", Rounded(*low, 4),
                 Rounded(*high, 4)});
    }
  }
  return table;
}

// A parameter of one group over the bootstrap replicas of that group.
struct BootstrapSpread {
  const BatchJob* job;  // replica 0
  std::string parameter;
  double estimate;
  int replicas;
  double standard_error, lower95, upper95;
};

// Spreads of groups with at least two replicas.
std::vector<BootstrapSpread> SpreadOverReplicas(const std::vector<JobResult>& rows) {
  std::vector<BootstrapSpread> spreads;
  std::map<std::pair<std::string, std::string>, std::map<std::string, std::vector<double>>> drawn;
  for (const JobResult& row : rows) {
    if (row.job->replica == 0) continue;
    auto& values = drawn[{row.job->variant, row.job->group}];
    for (const auto& [name, e] : row.parameters) values[name].push_back(e.value);
  }
  for (const JobResult& row : rows) {
    if (row.job->replica > 0 || !row.done()) continue;
    for (const auto& [name, estimate] : row.parameters) {
      const std::vector<double>& values = drawn[{row.job->variant, row.job->group}][name];
      const int n = static_cast<int>(values.size());
      if (n < 2) continue;
      spreads.push_back({row.job, name, estimate.value, n, MeanAndDeviation(values).second,
                         Quantile(values, 0.025), Quantile(values, 0.975)});
    }
  }
  return spreads;
}

TextTable BootstrapTable(const std::vector<JobResult>& rows) {
  TextTable table({"variant", "group", "parameter", ">estimate", ">replicas", ">bootstrap error",
                   ">2.5 %", ">97.5 %"});
  for (const BootstrapSpread& s : SpreadOverReplicas(rows)) {
    if (table.rows().size() > kMostRowsOnPage) break;
    table.Add({s.job->variant, s.job->group, s.parameter, Rounded(s.estimate, 4),
               std::to_string(s.replicas), Rounded(s.standard_error, 3), Rounded(s.lower95, 4),
               Rounded(s.upper95, 4)});
  }
  return table;
}

// Every different warning with the number of jobs that have it.
TextTable WarningTable(const std::vector<JobResult>& rows) {
  std::vector<std::pair<std::string, std::vector<const JobResult*>>> warnings;
  for (const JobResult& row : rows) {
    for (const std::string& warning : row.warnings) {
      ValueOf(warning, &warnings).push_back(&row);
    }
  }
  TextTable table({">jobs", "the first", "warning"});
  for (const auto& [warning, jobs] : warnings) {
    if (table.rows().size() > kMostRowsOnPage) break;
    table.Add({std::to_string(jobs.size()), jobs[0]->job->id.substr(0, 8), warning});
  }
  return table;
}

TextTable FailureTable(const std::vector<JobResult>& rows) {
  TextTable table({"failed", "variant", "group", ">replica", "reason"});
  for (const JobResult& row : rows) {
    if (row.state != JobState::kFailed || table.rows().size() > kMostRowsOnPage) continue;
    table.Add({row.job->id.substr(0, 8), row.job->variant, row.job->group,
               std::to_string(row.job->replica), row.reason});
  }
  return table;
}

// exact: all columns in full precision, for summary.csv; otherwise those that people are shown.
TextTable JobTable(const std::vector<JobResult>& rows, bool exact) {
  std::vector<JobColumn> columns;
  std::vector<std::string> header;
  for (JobColumn& column : JobColumns(rows)) {
    if (!exact && column.title.empty()) continue;
    header.push_back(exact ? column.name : (column.words ? "" : ">") + column.title);
    columns.push_back(std::move(column));
  }
  TextTable table(header);
  for (const JobResult& row : rows) {
    if (!exact && table.rows().size() > kMostRowsOnPage) break;
    std::vector<std::string> cells;
    for (const JobColumn& column : columns) {
      const JobCell cell = column.cell(row);
      cells.push_back(exact ? cell.exact : cell.shown);
    }
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
  ReportSection variants{"variants", "Variants"}, failures{"failures", "Failures"},
      warnings{"warnings", "Warnings"}, jobs{"jobs", "Jobs"};
  variants.Show("estimates over groups", VariantTable(rows));
  variants.Show("errors on held-out recordings", HeldOutTable(rows));
  variants.Show("bootstrap: spread over the replicas of each group", BootstrapTable(rows));
  failures.Show("", FailureTable(rows));
  failures.Say(failures.tables.empty() ? "None." : "The next run retries failed jobs.");
  warnings.Show("", WarningTable(rows));
  warnings.Say(warnings.tables.empty() ? "None." : "");
  if (rows.size() > kMostRowsOnPage) {
    jobs.Say("The first " + std::to_string(kMostRowsOnPage) + "; summary.csv has all of them.");
  }
  jobs.Show("", JobTable(rows, false));
  report.sections = {variants, failures, warnings, jobs};
  return report;
}

}  // namespace

std::vector<JobResult> ReadResults(const BatchPlan& plan, const std::vector<BatchJob>& jobs) {
  std::vector<JobResult> rows;
  for (const BatchJob& job : jobs) rows.push_back(ReadResult(plan, job));
  return rows;
}

void WriteSummary(const BatchPlan& plan, const std::vector<JobResult>& rows) {
  OrFail(WriteFileAtomically(plan.dir + "/summary.csv", CsvOf(JobTable(rows, true))));
  OrFail(WriteJson(plan.dir + "/summary.json", SummaryJson(plan, rows)));
  OrFail(WriteFileAtomically(plan.dir + "/summary.html", ToPage(PageOf(plan, rows))));
}

std::string SummaryText(const std::vector<JobResult>& rows) {
  const TextTable bootstrap = BootstrapTable(rows);
  const bool few = bootstrap.rows().size() <= kMostRowsInText;
  std::string text = VariantTable(rows).ToString();
  for (const TextTable& table :
       {HeldOutTable(rows), few ? bootstrap : TextTable({""}), FailureTable(rows)}) {
    if (!table.empty()) text += "\n" + table.ToString();
  }
  return text;
}

}  // namespace pushid
