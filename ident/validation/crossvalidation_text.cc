// ident: cross-validations in words and tables.
#include <cmath>

#include "datasets/files/number_text.h"
#include "ident/figures/text_table.h"
#include "ident/validation/score_cells.h"
#include "ident/validation/scores_report.h"

namespace pushid {
namespace {

// One honest sentence on two configurations: they differ where the 95 % interval of the difference
// excludes zero.
std::string ConclusionText(const PairedDifference& d) {
  if (d.clusters < 2) return d.b + " cannot be compared with " + d.a + ".";
  const HipMetric& metric = kHipMetrics[0];
  const double change = d.*metric.value, error = d.error.*metric.value;
  const std::string by = Rounded(std::abs(change), 2) + " +- " + Rounded(error, 2) + " " +
                         metric.unit + " of " + metric.name;
  const double half = StudentQuantile95(d.clusters - 1.0) * error;
  const std::string interval = "95 % interval +- " + Rounded(half, 2) + " " + metric.unit + ": " +
                               ClustersText(d.clustered_by, d.clusters) + ", Student's t with " +
                               std::to_string(d.clusters - 1) + " degree" +
                               (d.clusters > 2 ? "s" : "") + " of freedom";
  if (std::abs(change) <= half) {
    return d.b + " is not distinguishable from " + d.a + " (" + by + "; " + interval + ").";
  }
  return d.b + " predicts " + (change < 0.0 ? "better" : "worse") + " than " + d.a + " by " + by +
         " (" + interval + ").";
}

// Of --group_by; empty where no label tells recordings apart.
std::string HeldOutGroupsText(const std::vector<CrossValidation>& candidates,
                              const ShownMetrics& shown) {
  std::vector<std::string> header = {
      Together(MetricNames(shown)) + " in " + kHipMetrics[0].unit + ", held out", "recordings"};
  std::vector<const ScoreSummary*> summaries;
  for (const CrossValidation& candidate : candidates) {
    header.push_back(candidate.predictor);
    summaries.push_back(&candidate.summary);
  }
  std::vector<bool> left(header.size(), true);
  left[1] = false;
  TextTable table(header, left);
  AddGroups(summaries, shown, &table);
  return table.empty() ? "" : "\n" + table.ToString();
}

}  // namespace

std::string CrossValidationText(const std::vector<CrossValidation>& candidates) {
  std::string text;
  if (candidates.empty()) return text;
  const bool groups = candidates[0].summary.propagation.recordings > 0;
  const ShownMetrics shown = TableMetrics(candidates[0].summary.observed);
  std::vector<std::string> header = {"fold", "held out"};
  Append(Titles(shown), &header);
  Append({"failed", "fell"}, &header);
  if (groups) Append({"onset error", "missed movers", "false movers"}, &header);
  TextTable folds = TableOf(header, header.size());
  for (const FoldScore& fold : candidates[0].folds) {
    std::vector<std::string> row = {fold.name, std::to_string(fold.held_out)};
    Append(PlainCells(fold, shown), &row);
    Append({std::to_string(fold.failures), std::to_string(fold.falls)}, &row);
    if (groups) Append(FoldPropagationCells(fold.propagation), &row);
    folds.Add(row);
  }
  text += folds.ToString() + "\n";
  const HipMetric& main = kHipMetrics[0];
  header = {"held out"};
  Append(Titles(shown), &header);
  Append({"frame-weighted", std::string(main.name) + " - " + candidates[0].predictor}, &header);
  std::vector<bool> left(header.size(), true);
  Append({"failed", "fell", "fell harder", "settle", groups ? "harder, farther" : ""}, &header);
  left.resize(header.size(), false);
  TextTable table(header, left);
  const auto folds_that = [](int number, const CrossValidation& candidate) {
    return candidate.fits > 0 ? std::to_string(number) + " of " + std::to_string(candidate.fits)
                              : "";
  };
  for (const CrossValidation& candidate : candidates) {
    const PairedDifference difference = Compare(candidates[0], candidate);
    const bool compared = &candidate != &candidates[0] && difference.recordings > 0;
    std::vector<std::string> row = {candidate.predictor};
    Append(MeanCells(candidate.summary.mean, shown), &row);
    Append({Together(PlainCells(candidate.summary.frame_weighted, shown)),
            compared ? Rounded(difference.*main.value, 2) + " +- " +
                           Rounded(difference.error.*main.value, 2)
                     : "",
            std::to_string(candidate.failures), std::to_string(candidate.falls),
            candidate.fits > 0 ? std::to_string(candidate.falls_harder) : "",
            folds_that(candidate.settling, candidate),
            groups ? folds_that(candidate.harder_farther, candidate) : ""},
           &row);
    table.Add(row);
  }
  text += table.ToString() + ErrorsText(candidates[0].summary) +
          ObservedText(candidates[0].summary) +
          "fell harder: when pushed 1.4 times as hard, until 40 frames past the recording's end\n";
  for (size_t i = 1; i < candidates.size(); ++i) {
    text += ConclusionText(Compare(candidates[0], candidates[i])) + "\n";
  }
  text += HeldOutGroupsText(candidates, shown);
  std::vector<std::pair<std::string, const StepScore*>> steps;
  for (const CrossValidation& candidate : candidates) {
    steps.emplace_back(candidate.predictor, &candidate.summary.steps);
  }
  const std::string who_steps = StepScoresText(steps);
  if (!who_steps.empty()) text += "\n" + who_steps;
  if (!groups) return text;
  std::vector<PropagationColumn> columns;
  std::vector<GroupMetricsRow> metrics;
  for (const CrossValidation& candidate : candidates) {
    columns.push_back({candidate.predictor, &candidate.summary.propagation});
    if (candidate.groups) metrics.push_back({candidate.predictor, &*candidate.groups});
  }
  return text + "\n" + PropagationText(columns) +
         (metrics.empty() ? "" : "\n" + GroupMetricsText(metrics));
}

}  // namespace pushid
