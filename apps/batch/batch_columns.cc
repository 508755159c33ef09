// apps: name and cell of every column.
#include "apps/batch/batch_columns.h"

#include <cctype>
#include <cmath>
#include <set>

#include "datasets/files/number_text.h"

namespace pushid {
namespace {

JobCell Words(const std::string& text) { return {text, text}; }

JobCell Number(double value, int digits) {
  return {DoubleText(value), Rounded(value, digits), value};
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

JobColumn ParameterColumn(const std::string& name) {
  return {name, name, false, true, [name](const JobResult& row) {
            const auto found = row.parameters.find(name);
            if (found == row.parameters.end()) return Nothing();
            return JobCell{DoubleText(found->second),
                           EstimateText(found->second, row.errors.at(name), row.statuses.at(name)),
                           found->second};
          }};
}

// On the page error and status stand beside the value.
JobColumn ParameterErrorColumn(const std::string& name) {
  return {name + "_se", "", false, false, [name](const JobResult& row) {
            const auto found = row.errors.find(name);
            return found == row.errors.end() ? Nothing() : Number(found->second, 3);
          }};
}

JobColumn ParameterStatusColumn(const std::string& name) {
  return {name + "_status", "", true, false, [name](const JobResult& row) {
            const auto found = row.statuses.find(name);
            return found == row.statuses.end() ? Nothing() : Words(NameOf(found->second));
          }};
}

JobColumn ParameterDataShareColumn(const std::string& name) {
  return {name + "_data_share", "", false, false, [name](const JobResult& row) {
            const auto found = row.data_shares.find(name);
            return found == row.data_shares.end() ? Nothing() : Number(found->second, 3);
          }};
}

JobColumn HeldOutColumn(const Metric& metric) {
  return {"held_out_" + LowerCase(metric.name) + "_" + metric.unit,
          std::string("held-out ") + metric.name + ", " + metric.unit, false, false,
          [metric](const JobResult& row) {
            const double* const value = row.HeldOut(metric);
            return value != nullptr ? Number(*value, 3) : Nothing();
          }};
}

}  // namespace

std::vector<JobColumn> JobColumns(const std::vector<JobResult>& rows) {
  using Row = const JobResult&;
  std::vector<JobColumn> columns = {
      {"id", "job", true, false,
       [](Row r) {
         return JobCell{r.job->id, r.job->id.substr(0, 8)};
       }},
      {"variant", "variant", true, false, [](Row r) { return Words(r.job->variant); }},
      {"group", "group", true, false, [](Row r) { return Words(r.job->group); }},
      {"replica", "replica", false, false,
       [](Row r) { return Words(std::to_string(r.job->replica)); }},
      {"status", "status", true, false, [](Row r) { return Words(NameOf(r.status.state)); }},
      {"reason", "", true, false, [](Row r) { return Words(r.status.reason); }},
  };
  const std::vector<std::string> names = ParameterNames(rows);
  for (const std::string& name : names) columns.push_back(ParameterColumn(name));
  for (const std::string& name : names) columns.push_back(ParameterErrorColumn(name));
  for (const std::string& name : names) columns.push_back(ParameterStatusColumn(name));
  for (const std::string& name : names) columns.push_back(ParameterDataShareColumn(name));
  const auto add = [&columns](JobColumn column) { columns.push_back(std::move(column)); };
  add({"cost", "", false, false, [](Row r) { return r.done() ? Number(r.cost, 4) : Nothing(); }});
  add({"settles", "settles", false, false,
       [](Row r) { return r.done() ? Words(r.settles ? "yes" : "no") : Nothing(); }});
  for (const Metric& metric : HeldOutMetrics(rows)) add(HeldOutColumn(metric));
  add({"warnings", "warnings", false, false, [](Row r) {
         return JobCell{Joined(r.warnings),
                        r.warnings.empty() ? "" : std::to_string(r.warnings.size())};
       }});
  add({"solve_s", "solve s", false, false,
       [](Row r) { return r.done() ? Number(r.solve_s, 2) : Nothing(); }});
  add({"seconds", "seconds", false, false, [](Row r) {
         return r.status.state == JobState::kOpen ? Nothing() : Number(r.status.seconds, 2);
       }});
  return columns;
}

}  // namespace pushid
