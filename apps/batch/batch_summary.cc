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

constexpr size_t kMostRowsInText = 40;

// A column of the table. A new one is a row in JobColumns: summary.csv and summary.json take name,
// place and cell from there.
struct JobCell {
  std::string text{};             // in summary.csv
  nlohmann::ordered_json json{};  // null: not in summary.json
};

struct JobColumn {
  std::string name;   // in summary.csv
  std::string place;  // in a job of summary.json: "/run/seconds"
  std::function<JobCell(const JobResult&)> cell;
};

template <typename T>
void AddOnce(const T& one, std::vector<T>* all) {
  if (std::find(all->begin(), all->end(), one) == all->end()) all->push_back(one);
}

// The metrics of all jobs.
MetricList HeldOutMetrics(const std::vector<JobResult>& rows) {
  MetricList metrics;
  for (const JobResult& row : rows) {
    for (const auto& [metric, value] : row.held_out) AddOnce(metric, &metrics);
  }
  return metrics;
}

JobCell Words(const std::string& text) { return {text, text}; }

JobCell Number(double value) { return {DoubleText(value), NumberJson(value)}; }

JobCell Nothing() { return {}; }

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
      {"id", "/id", [](Row r) { return Words(r.job->id); }},
      {"variant", "/variant", [](Row r) { return Words(r.job->variant); }},
      {"group", "/group", [](Row r) { return Words(r.job->group); }},
      {"replica", "/replica",
       [](Row r) {
         return JobCell{std::to_string(r.job->replica), r.job->replica};
       }},
      {"status", "/status", [](Row r) { return Words(NameOf(r.state)); }},
      {"reason", "/reason", [](Row r) { return Words(r.reason); }},
  };
  const auto add = [&columns](JobColumn column) { columns.push_back(std::move(column)); };
  std::vector<std::string> names;  // in the order in which jobs first have them
  for (const JobResult& row : rows) {
    for (const auto& [name, value] : row.parameters) AddOnce(name, &names);
  }
  const auto of_parameters = [&](const char* ending, const char* key,
                                 JobCell (*cell)(const Estimate&)) {
    for (const std::string& name : names) {
      add({name + ending, Place("/parameters", name, key), [name, cell](Row r) {
             const auto found = r.parameters.find(name);
             return found == r.parameters.end() ? Nothing() : cell(found->second);
           }});
    }
  };
  of_parameters("", "/value", [](const Estimate& e) { return Number(e.value); });
  of_parameters("_se", "/standard_error",
                [](const Estimate& e) { return Number(e.standard_error); });
  of_parameters("_status", "/status", [](const Estimate& e) { return Words(NameOf(e.status)); });
  of_parameters("_data_share", "/data_share",
                [](const Estimate& e) { return Number(e.shares.data); });
  add({"cost", "/cost", [](Row r) { return r.done() ? Number(r.cost) : Nothing(); }});
  add({"settles", "/settles", [](Row r) {
         return r.done() ? JobCell{r.settles ? "yes" : "no", r.settles} : Nothing();
       }});
  for (MetricId id : HeldOutMetrics(rows)) {
    const Metric& metric = kMetrics[id];
    add({"held_out_" + LowerCase(metric.name) + "_" + metric.unit, Place("/held_out", metric.Key()),
         [id](Row r) {
           const double* const value = r.HeldOut(id);
           return value != nullptr ? Number(*value) : Nothing();
         }});
  }
  add({"warnings", "/warnings", [](Row r) {
         return r.warnings.empty() ? Nothing() : JobCell{Joined(r.warnings, "; "), r.warnings};
       }});
  add({"solve_s", "/run/solve_s", [](Row r) {
         return JobCell{r.done() ? DoubleText(r.solve_s) : "", r.solve_s};
       }});
  add({"seconds", "/run/seconds", [](Row r) {
         return JobCell{r.state == JobState::kOpen ? "" : DoubleText(r.seconds), r.seconds};
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
    table.Add({s.job->variant, s.job->group, s.parameter, Rounded(s.estimate, 4),
               std::to_string(s.replicas), Rounded(s.standard_error, 3), Rounded(s.lower95, 4),
               Rounded(s.upper95, 4)});
  }
  return table;
}

TextTable FailureTable(const std::vector<JobResult>& rows) {
  TextTable table({"failed", "variant", "group", ">replica", "reason"});
  for (const JobResult& row : rows) {
    if (row.state != JobState::kFailed) continue;
    table.Add({row.job->id.substr(0, 8), row.job->variant, row.job->group,
               std::to_string(row.job->replica), row.reason});
  }
  return table;
}

// A row for each job, with all columns.
TextTable JobTable(const std::vector<JobResult>& rows) {
  const std::vector<JobColumn> columns = JobColumns(rows);
  std::vector<std::string> header;
  for (const JobColumn& column : columns) header.push_back(column.name);
  TextTable table(header);
  for (const JobResult& row : rows) {
    std::vector<std::string> cells;
    for (const JobColumn& column : columns) cells.push_back(column.cell(row).text);
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

}  // namespace

std::vector<JobResult> ReadResults(const BatchPlan& plan, const std::vector<BatchJob>& jobs) {
  std::vector<JobResult> rows;
  for (const BatchJob& job : jobs) rows.push_back(ReadResult(plan, job));
  return rows;
}

void WriteSummary(const BatchPlan& plan, const std::vector<JobResult>& rows) {
  OrFail(WriteFileAtomically(plan.dir + "/summary.csv", CsvOf(JobTable(rows))));
  OrFail(WriteJson(plan.dir + "/summary.json", SummaryJson(plan, rows)));
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
