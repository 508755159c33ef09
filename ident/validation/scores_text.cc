// ident: evaluations and cross-validations in words and tables.
#include <cmath>

#include "datasets/files/number_text.h"
#include "ident/figures/text_table.h"
#include "ident/uncertainty/uncertainty.h"
#include "ident/validation/scores_report.h"
#include "ident/validation/steps_report.h"

namespace pushid {
namespace {

// A single recording has no error.
std::string ScoreText(double value, double error, const MeanScore& mean) {
  if (mean.recordings == 0) return "-";
  return Rounded(value, 3) + (mean.recordings > 1 ? " +- " + Rounded(error, 2) : "");
}

// A cell for each metric.
std::vector<std::string> MeanCells(const MeanScore& mean, const ShownMetrics& shown) {
  std::vector<std::string> cells;
  for (const HipMetric& metric : shown) {
    cells.push_back(ScoreText(mean.*metric.value, mean.error.*metric.value, mean));
  }
  return cells;
}

// The same without errors; "-" where there is no score.
std::vector<std::string> PlainCells(const HipMetrics& metrics, const ShownMetrics& shown,
                                    bool known = true) {
  std::vector<std::string> cells;
  for (const HipMetric& metric : shown) {
    cells.push_back(known ? Rounded(metrics.*metric.value, 3) : "-");
  }
  return cells;
}

std::vector<std::string> Titles(const ShownMetrics& shown) {
  std::vector<std::string> titles;
  for (const HipMetric& metric : shown) titles.push_back(metric.Title());
  return titles;
}

std::vector<std::string> MetricNames(const ShownMetrics& shown) {
  std::vector<std::string> names;
  for (const HipMetric& metric : shown) names.push_back(metric.name);
  return names;
}

// "a / b"
std::string Together(const std::vector<std::string>& cells) {
  std::string text;
  for (const std::string& cell : cells) text += (text.empty() ? "" : " / ") + cell;
  return text;
}

std::string MeanText(const MeanScore& mean, const ShownMetrics& shown) {
  return Together(MeanCells(mean, shown));
}

void Append(const std::vector<std::string>& cells, std::vector<std::string>* row) {
  row->insert(row->end(), cells.begin(), cells.end());
}

// Over what the errors of a summary's means are. A row of one person's recordings has no other
// people to be clustered by.
std::string ErrorsText(const ScoreSummary& summary) {
  if (summary.mean.clusters < 2) return "";
  const bool people = summary.mean.clustered_by == ClusterBy::kSubject;
  return "+-: standard errors over " +
         ClustersText(summary.mean.clustered_by, summary.mean.clusters) +
         (people ? "; within one person, over recordings" : "") + "\n";
}

// Text stands to the left in the first column and in those from `text_from` on.
TextTable TableOf(const std::vector<std::string>& header, size_t text_from) {
  std::vector<bool> left(header.size(), false);
  for (size_t i = 0; i < left.size(); ++i) left[i] = i == 0 || i >= text_from;
  return TextTable(header, left);
}

// "the first 12 frames were seen; 90 % bands hold 0.93 +- 0.03 (x) and 0.91 +- 0.05 (y) of ..."
std::string ObservedText(const ScoreSummary& summary) {
  if (summary.observed == 0) return "";
  std::string text = "the first " + std::to_string(summary.observed) +
                     (summary.observed == 1 ? " frame was" : " frames were") +
                     " seen, which have no error; after_hipADE: mean over the others";
  if (!summary.bands) return text + "\n";
  const char* const axes[] = {" (x)", " (y)"};
  text += "\n90 % bands hold ";
  for (int i : {0, 1}) {
    const auto value = kBandMetrics[i].value;
    text += (i > 0 ? " and " : "") +
            ScoreText(summary.mean.*value, summary.mean.error.*value, summary.mean) + axes[i];
  }
  return text + " of these frames of the pushed person\n";
}

}  // namespace

namespace {

std::vector<const ScoreSummary*> Baselines(const Evaluation& evaluation) {
  std::vector<const ScoreSummary*> baselines = {&evaluation.static_baseline,
                                                &evaluation.constant_velocity};
  if (evaluation.reanchored) baselines.push_back(&*evaluation.reanchored);
  return baselines;
}

// None where a baseline failed in all of a group.
MeanScore MeanOfGroup(const std::map<std::string, MeanScore>& groups, const std::string& name) {
  const auto found = groups.find(name);
  return found == groups.end() ? MeanScore() : found->second;
}

// Before the name of a group.
std::string GroupTitle(const std::string& key, const ScoreSummary& summary) {
  if (key == kMagnitudeLabel) return "strength ";
  const bool one_of_several = key == kSubjectUnit && summary.propagation.recordings > 0;
  return (one_of_several ? "pushed person" : key) + " ";
}

// A row for each group of a label that tells recordings apart, a column for each summary.
void AddGroups(const std::vector<const ScoreSummary*>& summaries, const ShownMetrics& shown,
               TextTable* table) {
  for (const auto& [key, groups] : summaries[0]->by) {
    if (groups.size() < 2) continue;
    for (const auto& [name, mean] : groups) {
      std::vector<std::string> row = {GroupTitle(key, *summaries[0]) + name,
                                      std::to_string(mean.recordings)};
      for (const ScoreSummary* one : summaries) {
        row.push_back(MeanText(MeanOfGroup(one->by.at(key), name), shown));
      }
      table->Add(row);
    }
  }
}

}  // namespace

std::string EvaluationText(const Evaluation& evaluation, bool per_recording) {
  std::string text;
  const ShownMetrics shown = MetricsOf(evaluation.model.observed, false);
  if (per_recording) {
    std::vector<std::string> header = {"recording", "frames"};
    Append(Titles(shown), &header);
    Append({"static", "const velocity"}, &header);
    if (evaluation.reanchored) header.push_back("re-anchored");
    header.push_back("");
    TextTable table = TableOf(header, header.size() - 1);
    for (size_t i = 0; i < evaluation.model.recordings.size(); ++i) {
      const RecordingScore& r = evaluation.model.recordings[i];
      std::vector<std::string> row = {r.id, std::to_string(r.frames)};
      Append(PlainCells(r, shown, r.failure.empty()), &row);
      for (const ScoreSummary* baseline : Baselines(evaluation)) {
        row.push_back(PlainCells(baseline->recordings[i], shown)[0]);
      }
      row.push_back(r.failure);
      table.Add(row);
    }
    text += table.ToString() + "\n";
    if (evaluation.model.propagation.recordings > 0) {
      text += OnsetsText(evaluation.model.recordings) + "\n";
    }
  }
  std::vector<std::string> header = {Together(MetricNames(shown)) + " in " + kHipMetrics[0].unit,
                                     "recordings", "model", "static", "constant velocity"};
  if (evaluation.reanchored) header.push_back("re-anchored");
  std::vector<bool> left(header.size(), true);
  left[1] = false;
  TextTable table(header, left);
  const ScoreSummary& m = evaluation.model;
  const std::vector<const ScoreSummary*> baselines = Baselines(evaluation);
  // pick: the mean of a summary.
  const auto add = [&](const std::string& name, const auto& pick) {
    std::vector<std::string> row = {name, std::to_string(pick(m).recordings),
                                    MeanText(pick(m), shown)};
    for (const ScoreSummary* baseline : baselines) row.push_back(MeanText(pick(*baseline), shown));
    table.Add(row);
  };
  add("mean over recordings", [](const ScoreSummary& of) -> const MeanScore& { return of.mean; });
  add("frame-weighted",
      [](const ScoreSummary& of) -> const MeanScore& { return of.frame_weighted; });
  std::vector<const ScoreSummary*> all = {&m};
  all.insert(all.end(), baselines.begin(), baselines.end());
  AddGroups(all, shown, &table);
  text += table.ToString() + WithoutLabelText(m.without_label) + ErrorsText(m) + ObservedText(m);
  if (m.steps.known()) text += "\n" + StepScoresText({{"model", &m.steps}});
  if (m.propagation.recordings == 0) return text;
  std::vector<PropagationColumn> columns = {{"model", &m.propagation}};
  if (m.propagation_by_setting.size() > 1) {
    for (const auto& [name, setting] : m.propagation_by_setting)
      columns.push_back({name, &setting});
  }
  columns.push_back({"constant velocity", &evaluation.constant_velocity.propagation});
  return text + "\n" + PropagationText(columns);
}

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

}  // namespace

namespace {

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
  const ShownMetrics shown = MetricsOf(candidates[0].summary.observed, false);
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
