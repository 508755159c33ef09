// apps: what a batch's jobs found, in tables for people.
#include "apps/batch/batch_tables.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "datasets/files/number_text.h"
#include "ident/uncertainty/bootstrap.h"

namespace pushid {
namespace {

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
    if (row.job->replica > 0) continue;
    for (const auto& [name, value] : row.parameters) at->second.values[name].push_back(value);
    if (row.hip_ade < 0.0) continue;
    at->second.values["held-out hipADE, m"].push_back(row.hip_ade);
    at->second.values["held-out hipFDE, m"].push_back(row.hip_fde);
  }
  return variants;
}

std::string WithError(double value, double error) {
  const std::string text = Rounded(value, 4);
  return std::isfinite(error) ? text + " +- " + Rounded(error, 3) : text + " (unidentifiable)";
}

}  // namespace

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

TextTable VariantTable(const std::vector<JobResult>& rows) {
  TextTable table({"variant", "jobs done", "failed", "open", "over groups", "mean", "std deviation",
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
      auto at = std::find_if(warnings.begin(), warnings.end(),
                             [&warning](const auto& one) { return one.first == warning; });
      if (at == warnings.end()) at = warnings.insert(warnings.end(), {warning, {}});
      at->second.push_back(&row);
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
    if (row.status != "failed" || table.rows().size() > kMostRowsOnPage) continue;
    table.Add({row.job->id.substr(0, 8), row.job->variant, row.job->group,
               std::to_string(row.job->replica), row.reason});
  }
  return table;
}

TextTable JobTable(const std::vector<JobResult>& rows) {
  const std::vector<std::string> names = ParameterNames(rows);
  std::vector<std::string> header = {"job", "variant", "group", "replica", "status"};
  header.insert(header.end(), names.begin(), names.end());
  header.insert(header.end(), {"settles", "held-out hipADE, m", "held-out hipFDE, m", "solve s",
                               "seconds", "warnings"});
  std::vector<bool> words(header.size(), false);
  std::fill(words.begin(), words.begin() + 3, true);
  words[4] = true;
  TextTable table(header, words);
  for (const JobResult& row : rows) {
    if (table.rows().size() > kMostRowsOnPage) break;
    std::vector<std::string> cells = {row.job->id.substr(0, 8), row.job->variant, row.job->group,
                                      std::to_string(row.job->replica), row.status};
    for (const std::string& name : names) {
      const auto found = row.parameters.find(name);
      cells.push_back(
          found == row.parameters.end() ? "" : WithError(found->second, row.errors.at(name)));
    }
    const bool done = row.done();
    cells.push_back(done ? (row.settles ? "yes" : "no") : "");
    cells.push_back(row.hip_ade >= 0.0 ? Rounded(row.hip_ade, 3) : "");
    cells.push_back(row.hip_fde >= 0.0 ? Rounded(row.hip_fde, 3) : "");
    cells.push_back(done ? Rounded(row.solve_s, 2) : "");
    cells.push_back(row.status == "open" ? "" : Rounded(row.seconds, 2));
    cells.push_back(row.warnings.empty() ? "" : std::to_string(row.warnings.size()));
    table.Add(cells);
  }
  return table;
}

}  // namespace pushid
