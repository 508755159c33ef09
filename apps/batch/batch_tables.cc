// apps: what a batch's jobs found, in tables for people.

#include <algorithm>
#include <cmath>

#include "apps/batch/batch.h"
#include "datasets/files/number_text.h"
#include "ident/problem/statistics.h"
#include "ident/uncertainty/bootstrap.h"

namespace pushid {
namespace {

struct VariantSummary {
  std::map<JobState, int> jobs;
  std::map<std::string, std::vector<double>> values;
};

std::vector<std::pair<std::string, VariantSummary>> ByVariant(const std::vector<JobResult>& rows) {
  std::vector<std::pair<std::string, VariantSummary>> variants;
  const std::vector<JobColumn> columns = JobColumns(rows);
  for (const JobResult& row : rows) {
    VariantSummary& variant = ValueOf(row.job->variant, &variants);
    ++variant.jobs[row.status.state];
    if (row.job->replica > 0) continue;
    for (const JobColumn& column : columns) {
      if (!column.over_groups) continue;
      const std::optional<double> number = column.cell(row).number;
      if (number) variant.values[column.title].push_back(*number);
    }
  }
  return variants;
}

// The folds of one group: what each variant scored on each.
struct FoldScores {
  std::vector<std::string> variants;  // in the plan's order
  std::vector<std::string> folds;
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

void AddOnce(const std::string& name, std::vector<std::string>* names) {
  if (std::find(names->begin(), names->end(), name) == names->end()) names->push_back(name);
}

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

// "0.0123 +- 0.0045" of paired values; the error over folds.
std::string MeanWithError(const std::vector<double>& values) {
  if (values.size() < 2) return "-";
  const MeanAndError mean = MeanOf(values);
  return Rounded(mean.mean, 3) + " +- " + Rounded(mean.error, 2);
}

std::vector<std::string> HeldOutRow(const std::string& group, const std::string& variant,
                                    const FoldScores& of, const std::vector<Metric>& metrics) {
  const std::vector<std::string> compared = of.FoldsOfAll();
  std::string missing;
  for (const std::string& fold : of.folds) {
    // "X05 fold 2 of 4": the group stands in the row already.
    if (!of.Has(variant, fold))
      missing += (missing.empty() ? "" : ", ") + fold.substr(group.size() + 1);
  }
  std::vector<std::string> cells = {
      group, variant, std::to_string(compared.size()) + " of " + std::to_string(of.folds.size())};
  for (const Metric& metric : metrics) {
    std::vector<double> values, differences;
    for (const std::string& fold : compared) {
      const double* const value = of.scores.at({variant, fold})->HeldOut(metric);
      const double* const first = of.scores.at({of.variants[0], fold})->HeldOut(metric);
      if (value != nullptr) values.push_back(*value);
      if (value != nullptr && first != nullptr) differences.push_back(*value - *first);
    }
    cells.push_back(values.empty() ? "-" : Rounded(MeanOf(values).mean, 3));
    cells.push_back(variant == of.variants[0] ? "-" : MeanWithError(differences));
  }
  cells.push_back(missing.empty() ? "-" : missing);
  return cells;
}

}  // namespace

TextTable HeldOutTable(const std::vector<JobResult>& rows) {
  std::vector<std::string> header = {"group", "variant", "folds compared"};
  const std::vector<Metric> metrics = HeldOutMetrics(rows);
  for (const Metric& metric : metrics) {
    header.push_back(std::string("held-out ") + metric.name + ", " + metric.unit);
    header.push_back("minus the first variant");
  }
  header.push_back("folds missing");
  std::vector<bool> words(header.size(), false);
  words[0] = words[1] = words.back() = true;
  TextTable table(header, words);
  for (const auto& [group, scores] : ByGroup(rows)) {
    for (const std::string& variant : scores.variants) {
      table.Add(HeldOutRow(group, variant, scores, metrics));
    }
  }
  return table;
}

TextTable VariantTable(const std::vector<JobResult>& rows) {
  TextTable table({"variant", "jobs done", "failed", "open", "over groups", "mean", "std deviation",
                   "lowest", "highest"},
                  {true, false, false, false, true, false, false, false, false});
  for (const auto& [name, v] : ByVariant(rows)) {
    std::vector<std::string> counts = {name};
    for (JobState state : {JobState::kDone, JobState::kFailed, JobState::kOpen}) {
      const auto found = v.jobs.find(state);
      counts.push_back(std::to_string(found == v.jobs.end() ? 0 : found->second));
    }
    table.Add(counts);
    for (const auto& [what, values] : v.values) {
      double sum = 0.0, squares = 0.0;
      for (double value : values) sum += value;
      const double n = static_cast<double>(values.size()), mean = sum / n;
      for (double value : values) squares += (value - mean) * (value - mean);
      const auto [low, high] = std::minmax_element(values.begin(), values.end());
      table.Add({"", "", "", "", what, Rounded(mean, 4),
                 values.size() > 1 ? Rounded(std::sqrt(squares / (n - 1.0)), 3) : "-",
                 Rounded(*low, 4), Rounded(*high, 4)});
    }
  }
  return table;
}

std::vector<BootstrapSpread> SpreadOverReplicas(const std::vector<JobResult>& rows) {
  std::vector<BootstrapSpread> spreads;
  std::map<std::pair<std::string, std::string>, std::map<std::string, std::vector<double>>> drawn;
  for (const JobResult& row : rows) {
    if (row.job->replica == 0) continue;
    auto& values = drawn[{row.job->variant, row.job->group}];
    for (const auto& [name, value] : row.parameters) values[name].push_back(value);
  }
  for (const JobResult& row : rows) {
    if (row.job->replica > 0 || !row.done()) continue;
    for (const auto& [name, estimate] : row.parameters) {
      const std::vector<double>& values = drawn[{row.job->variant, row.job->group}][name];
      const int n = static_cast<int>(values.size());
      if (n < 2) continue;
      double sum = 0.0, squares = 0.0;
      for (double value : values) sum += value;
      for (double value : values) squares += (value - sum / n) * (value - sum / n);
      spreads.push_back({row.job, name, estimate, n, std::sqrt(squares / (n - 1)),
                         Quantile(values, 0.025), Quantile(values, 0.975)});
    }
  }
  return spreads;
}

TextTable BootstrapTable(const std::vector<JobResult>& rows) {
  TextTable table({"variant", "group", "parameter", "estimate", "replicas", "bootstrap error",
                   "2.5 %", "97.5 %"},
                  {true, true, true, false, false, false, false, false});
  for (const BootstrapSpread& s : SpreadOverReplicas(rows)) {
    if (table.rows().size() > kMostRowsOnPage) break;
    table.Add({s.job->variant, s.job->group, s.parameter, Rounded(s.estimate, 4),
               std::to_string(s.replicas), Rounded(s.standard_error, 3), Rounded(s.lower95, 4),
               Rounded(s.upper95, 4)});
  }
  return table;
}

TextTable WarningTable(const std::vector<JobResult>& rows) {
  std::vector<std::pair<std::string, std::vector<const JobResult*>>> warnings;
  for (const JobResult& row : rows) {
    for (const std::string& warning : row.warnings) {
      ValueOf(warning, &warnings).push_back(&row);
    }
  }
  TextTable table({"jobs", "the first", "warning"}, {false, true, true});
  for (const auto& [warning, jobs] : warnings) {
    if (table.rows().size() > kMostRowsOnPage) break;
    table.Add({std::to_string(jobs.size()), jobs[0]->job->id.substr(0, 8), warning});
  }
  return table;
}

TextTable FailureTable(const std::vector<JobResult>& rows) {
  TextTable table({"failed", "variant", "group", "replica", "reason"},
                  {true, true, true, false, true});
  for (const JobResult& row : rows) {
    if (row.status.state != JobState::kFailed || table.rows().size() > kMostRowsOnPage) continue;
    table.Add({row.job->id.substr(0, 8), row.job->variant, row.job->group,
               std::to_string(row.job->replica), row.status.reason});
  }
  return table;
}

TextTable JobTable(const std::vector<JobResult>& rows) {
  std::vector<JobColumn> columns;
  std::vector<std::string> header;
  std::vector<bool> words;
  for (const JobColumn& column : JobColumns(rows)) {
    if (column.title.empty()) continue;
    columns.push_back(column);
    header.push_back(column.title);
    words.push_back(column.words);
  }
  TextTable table(header, words);
  for (const JobResult& row : rows) {
    if (table.rows().size() > kMostRowsOnPage) break;
    std::vector<std::string> cells;
    for (const JobColumn& column : columns) cells.push_back(column.cell(row).shown);
    table.Add(cells);
  }
  return table;
}

}  // namespace pushid
