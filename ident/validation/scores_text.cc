// ident: evaluations in words and tables.

#include "datasets/files/number_text.h"
#include "ident/figures/text_table.h"
#include "ident/validation/score_cells.h"
#include "ident/validation/scores_report.h"

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

namespace {

std::string FigureText(const PropagationMean& mean) {
  if (!mean.known()) return "-";
  return WithError(mean.value, mean.error);
}

// The onset errors of those who move in both say little where most movers are missed: a model that
// moves only the pushed person would look best.
bool MostMissed(const PropagationSummary& s) { return s.missed_movers > 0.5 * s.movers; }

bool OfThoseWhoMoveInBoth(int figure) {
  return figure == kOnsetError || figure == kOnsetErrorReached || figure == kOnsetBias;
}

std::string CountsText(double part, double whole) {
  return Rounded(part, 3) + " of " + Rounded(whole, 4);
}

std::string OnsetText(int frame) { return frame < 0 ? "-" : std::to_string(frame); }

}  // namespace

std::string SpeedText(const PropagationMean& slowness) {
  const std::optional<PropagationMean> speed = Speed(slowness);
  return speed ? FigureText(*speed) : (slowness.known() ? "undefined" : "-");
}

TextTable PropagationTable(const std::vector<PropagationColumn>& columns) {
  std::vector<std::string> header = {"propagation"};
  for (const PropagationColumn& column : columns) header.push_back(column.name);
  TextTable table(header);
  auto row = [&](const std::string& title, auto&& cell) {
    std::vector<std::string> cells = {title};
    for (const PropagationColumn& column : columns) cells.push_back(cell(*column.summary));
    table.Add(cells);
  };
  using S = PropagationSummary;
  row("recordings", [](const S& s) { return std::to_string(s.recordings); });
  row("missed movers", [](const S& s) { return CountsText(s.missed_movers, s.movers); });
  row("false movers", [](const S& s) { return CountsText(s.false_movers, s.bystanders); });
  for (int i = 0; i < kNumPropagationFigures; ++i) {
    bool any = false;
    for (const PropagationColumn& column : columns) any |= column.summary->figures[i].known();
    if (!any) continue;
    row(Info(static_cast<PropagationFigure>(i)).title, [i](const S& s) {
      return OfThoseWhoMoveInBoth(i) && MostMissed(s) ? "-" : FigureText(s.figures[i]);
    });
    if (i == kSlownessMeasured || i == kSlownessPredicted) {
      row("  speed, m/s", [i](const S& s) { return SpeedText(s.figures[i]); });
    }
  }
  return table;
}

std::string PropagationText(const std::vector<PropagationColumn>& columns) {
  const std::string text = PropagationTable(columns).ToString();
  for (const PropagationColumn& column : columns) {
    if (!MostMissed(*column.summary)) continue;
    return text + "onset error -: most movers are missed; see the row that counts them\n";
  }
  return text;
}

std::vector<std::string> FoldPropagationCells(const PropagationSummary& s) {
  const PropagationMean& onset = s.figures[kOnsetError];
  const bool says = onset.known() && !MostMissed(s);
  return {says ? Rounded(onset.value, 3) : "-", CountsText(s.missed_movers, s.movers),
          CountsText(s.false_movers, s.bystanders)};
}

std::string OnsetsText(const std::vector<RecordingScore>& scores) {
  TextTable table({"onset frames", "measured / predicted, from the pushed person on"});
  for (const RecordingScore& score : scores) {
    std::vector<std::string> by_rank(score.propagation.people.size());
    for (const PersonPropagation& person : score.propagation.people) {
      by_rank[person.rank] =
          OnsetText(person.onset_measured) + "/" + OnsetText(person.onset_predicted);
    }
    std::string line;
    for (const std::string& cell : by_rank)
      line += cell + std::string(9 - std::min<size_t>(8, cell.size()), ' ');
    if (!line.empty()) table.Add({score.id, line});
  }
  return table.ToString();
}

}  // namespace pushid
