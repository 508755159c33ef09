// ident: evaluations in words and tables.
#include <cmath>

#include "datasets/files/number_text.h"
#include "ident/figures/text_table.h"
#include "ident/uncertainty/uncertainty.h"
#include "ident/validation/score_cells.h"
#include "ident/validation/scores_report.h"
#include "ident/validation/steps_report.h"

namespace pushid {
std::string EvaluationText(const Evaluation& evaluation, bool per_recording) {
  std::string text;
  const ShownMetrics shown = TableMetrics(evaluation.model.observed);
  if (per_recording) {
    std::vector<std::string> header = {"recording", "frames"};
    Append(Titles(shown), &header);
    for (const BaselineSummary& baseline : evaluation.baselines) header.push_back(baseline.name);
    header.push_back("");
    TextTable table = TableOf(header, header.size() - 1);
    for (size_t i = 0; i < evaluation.model.recordings.size(); ++i) {
      const RecordingScore& r = evaluation.model.recordings[i];
      std::vector<std::string> row = {r.id, std::to_string(r.frames)};
      Append(PlainCells(r, shown, r.failure.empty()), &row);
      for (const BaselineSummary& baseline : evaluation.baselines) {
        row.push_back(PlainCells(baseline.summary.recordings[i], shown)[0]);
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
                                     "recordings", "model"};
  for (const BaselineSummary& baseline : evaluation.baselines) header.push_back(baseline.name);
  std::vector<bool> left(header.size(), true);
  left[1] = false;
  TextTable table(header, left);
  const ScoreSummary& m = evaluation.model;
  std::vector<const ScoreSummary*> baselines;
  for (const BaselineSummary& baseline : evaluation.baselines) {
    baselines.push_back(&baseline.summary);
  }
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
  columns.push_back({"constant velocity", &evaluation.Baseline("constant_velocity").propagation});
  return text + "\n" + PropagationText(columns);
}

}  // namespace pushid
