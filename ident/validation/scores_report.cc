// ident: scores to JSON and back, and in words and tables. Each list of entries of the JSON serves
// writing and reading alike (parameters/json_archive.h). Units stand in the keys. Which metrics
// there are depends on what was asked of the predictor, so the lists of what holds metrics take
// those that are shown.
#include "ident/validation/scores_report.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <tuple>

#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "ident/model/model_json.h"
#include "ident/parameters/json_archive.h"
#include "ident/validation/steps_report.h"

namespace pushid {
namespace {

// A single recording has no error.
std::string ScoreText(double value, double error, const MeanScore& mean) {
  if (mean.recordings == 0) return "-";
  return Rounded(value, 3) + (mean.recordings > 1 ? " +- " + Rounded(error, 2) : "");
}

// The mean of a group; none where a baseline failed in all of it.
MeanScore MeanOfGroup(const std::map<std::string, MeanScore>& groups, const std::string& name) {
  const auto found = groups.find(name);
  return found == groups.end() ? MeanScore() : found->second;
}

// The word before the name of a group.
std::string GroupTitle(const std::string& key, const ScoreSummary& summary) {
  if (key == kMagnitudeLabel) return "strength ";
  const bool one_of_several = key == kSubjectUnit && summary.propagation.recordings > 0;
  return (one_of_several ? "pushed person" : key) + " ";
}

std::vector<std::string> MeanCells(const MeanScore& mean, const ShownMetrics& shown) {
  std::vector<std::string> cells;
  for (const HipMetric& metric : shown) {
    cells.push_back(ScoreText(mean.*metric.value, mean.error.*metric.value, mean));
  }
  return cells;
}

// Cells without errors; "-" where there is no score.
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

std::string MeanText(const MeanScore& mean, const ShownMetrics& shown) {
  return Joined(MeanCells(mean, shown), " / ");
}

void Append(const std::vector<std::string>& cells, std::vector<std::string>* row) {
  row->insert(row->end(), cells.begin(), cells.end());
}

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

std::string ObservedText(const ScoreSummary& summary) {
  if (summary.observed == 0) return "";
  return "the first " + CountText(summary.observed, "frame was", "frames were") +
         " seen, which have no error; after_hipADE: mean over the others\n";
}

// Coverage of predictions that are distributions.
std::string BandsText(const std::string& name, const ScoreSummary& summary) {
  if (!summary.bands) return "";
  const auto text = [&](double HipMetrics::*value) {
    return ScoreText(summary.mean.*value, summary.mean.error.*value, summary.mean);
  };
  return name + ": 90 % bands hold " + text(&HipMetrics::inside90_x) + " (x) and " +
         text(&HipMetrics::inside90_y) +
         " (y) of the predicted frames of the pushed person, 50 % " +
         text(&HipMetrics::inside50_x) + " and " + text(&HipMetrics::inside50_y) + "; CRPS " +
         text(&HipMetrics::crps) + " m\n";
}

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
  }
  std::vector<std::string> header = {
      Joined(MetricNames(shown), " / ") + " in " + kHipMetrics[0].unit, "recordings", "model"};
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
  text += table.ToString() + WithoutLabelText(m.without_label) + ErrorsText(m) + ObservedText(m) +
          BandsText("model", m);
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

// A table by --group_by; empty where no label tells recordings apart.
std::string HeldOutGroupsText(const std::vector<CrossValidation>& candidates,
                              const ShownMetrics& shown) {
  std::vector<std::string> header = {
      Joined(MetricNames(shown), " / ") + " in " + kHipMetrics[0].unit + ", held out",
      "recordings"};
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
    Append({Joined(PlainCells(candidate.summary.frame_weighted, shown), " / "),
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
  for (const CrossValidation& candidate : candidates) {
    text += BandsText(candidate.predictor, candidate.summary);
  }
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

// Scores of who steps.

template <class Archive>
void Fields(Archive& a, StepFifth& f) {
  PUSHID_FIELDS(a, f, tracks, predicted, observed);
}

template <class Archive>
void Fields(Archive& a, StepScore& s) {
  PUSHID_FIELDS(a, s, tracks, stepped, people, brier, brier_error, auc, auc_error, fifths);
  if (!a.Has("lift_off", s.lift_off.people > 0)) return;
  a.Group("lift_off", [&](auto& g) {
    g("people", s.lift_off.people);
    g("median_error_s", s.lift_off.median);
    g("mean_absolute_error_s", s.lift_off.mean_absolute);
    g("landed", s.lift_off.landed);
    g("place_error_m", s.lift_off.place);
  });
}

void Fields(JsonWriter& a, StepPrediction& s) {
  a("margin_m", s.margin);
  PUSHID_FIELDS(a, s, probability, stepped);
  if (!s.timing) return;
  // All three are null where the model has the person stand.
  std::optional<Eigen::Vector2d> travel;
  if (s.timing->lift_off) travel = s.timing->travel;
  a.OrNull("lift_off_s", s.timing->lift_off);
  a.OrNull("landing_s", s.timing->landing);
  a.OrNull("travel_m", travel);
}

// Propagation.

template <class Archive>
void Fields(Archive& a, PropagationMean& m) {
  a("value", m.value);
  a("standard_error", m.error);
  a("of", m.weight);
}

// Null where it is not known.
template <class Archive>
void FigureField(Archive& a, const char* key, PropagationMean& mean) {
  std::optional<PropagationMean> known;
  if (mean.known()) known = mean;
  a.OrNull(key, known);
  if (known) mean = *known;
}

template <class Archive>
void Fields(Archive& a, PropagationSummary& s) {
  a("recordings", s.recordings);
  a.Written("onset_distance_m", [] { return kOnsetDistance; });
  PUSHID_FIELDS(a, s, movers, bystanders, missed_movers, false_movers);
  for (int i = 0; i < kNumPropagationFigures; ++i) {
    FigureField(a, Info(static_cast<PropagationFigure>(i)).key, s.figures[i]);
  }
  if constexpr (!Archive::kReads) {
    a.OrNull("speed_measured_m_per_s", Speed(s.figures[kSlownessMeasured]));
    a.OrNull("speed_predicted_m_per_s", Speed(s.figures[kSlownessPredicted]));
  }
}

void Fields(JsonWriter& a, PersonPropagation& p) {
  a("rank", p.rank);
  a("distance_m", p.distance);
  a("onset_measured_frame", p.onset_measured);
  a("onset_predicted_frame", p.onset_predicted);
  a("peak_momentum_measured_N_s", p.peak_momentum_measured);
  a("peak_momentum_predicted_N_s", p.peak_momentum_predicted);
  a("impulse_passed_on_N_s", p.impulse_on);
  a("contact_work_J", p.contact_work);
}

// Errors of the hip.

template <class Archive>
void MetricFields(Archive& a, HipMetrics& metrics, const ShownMetrics& shown) {
  for (const HipMetric& metric : shown) a(metric.Key().c_str(), metrics.*metric.value);
}

template <class Archive>
void ErrorFields(Archive& a, HipMetrics& errors, const ShownMetrics& shown) {
  for (const HipMetric& metric : shown) a(metric.ErrorKey().c_str(), errors.*metric.value);
}

template <class Archive>
void MeanFields(Archive& a, MeanScore& mean, const ShownMetrics& shown) {
  MetricFields(a, mean, shown);
  ErrorFields(a, mean.error, shown);
  a("recordings", mean.recordings);
  if (a.Has("clustered_by")) {
    PUSHID_FIELDS(a, mean, clustered_by, clusters);
  } else {  // older files: they were recordings
    mean.clusters = mean.recordings;
  }
}

template <class Archive>
void RecordingFields(Archive& a, RecordingScore& r, const ScoreSummary& of) {
  PUSHID_FIELDS(a, r, id, frames);
  if (a.Has("failure", !r.failure.empty())) {
    a("failure", r.failure);
  } else {
    MetricFields(a, r, MetricsOf(of.observed, of.bands));
  }
  a("fell", r.fell);
  // Entries for other readers than ours.
  if constexpr (!Archive::kReads) {
    if (!r.propagation.people.empty()) a("people", r.propagation.people);
    if (!r.steps.empty()) a("predicted_steps", r.steps);
  }
}

// A reader has to know `bands` and the groups' keys and names: what the file has.
template <class Archive>
void SummaryFields(Archive& a, ScoreSummary& s, bool with_recordings) {
  if (a.Has("observed", s.observed > 0)) a("observed", s.observed);
  const ShownMetrics shown = MetricsOf(s.observed, s.bands);
  const auto mean = [&shown](auto& g, const std::string& key, MeanScore& of) {
    g.Group(key.c_str(), [&](auto& inner) { MeanFields(inner, of, shown); });
  };
  if (with_recordings) {
    a.Rows("recordings", std::tie(s.recordings),
           [&s](auto& row, size_t i) { RecordingFields(row, s.recordings[i], s); });
  }
  mean(a, "mean", s.mean);
  mean(a, "frame_weighted", s.frame_weighted);
  for (auto& [key, groups] : s.by) {
    auto& means = groups;
    a.Group(("by_" + key).c_str(), [&](auto& g) {
      for (auto& [name, of_group] : means) mean(g, name, of_group);
    });
  }
  if (a.Has("without_label", !s.without_label.empty())) a("without_label", s.without_label);
  if (a.Has("propagation", s.propagation.recordings > 0)) {
    a.Group("propagation", [&s](auto& g) {
      Fields(g, s.propagation);
      if (g.Has("by_setting", !s.propagation_by_setting.empty())) {
        g("by_setting", s.propagation_by_setting);
      }
    });
  }
  if (a.Has("who_steps", s.steps.known())) a("who_steps", s.steps);
}

namespace {

using Json = nlohmann::ordered_json;

// A table of folds: those of a cross-validation.
void FoldFields(JsonWriter& a, FoldScore& fold, const ShownMetrics& shown) {
  PUSHID_FIELDS(a, fold, name, held_out);
  MetricFields(a, fold, shown);
  PUSHID_FIELDS(a, fold, failures, falls);
  if (fold.behaviour) a("behaviour", ToJson(*fold.behaviour));
  if (fold.propagation.recordings > 0) a("propagation", fold.propagation);
}

// Which groups a file has, for SummaryFields.
void ReadGroupNames(const Json& json, ScoreSummary* summary) {
  for (const auto& [key, groups] : json.items()) {
    if (key.rfind("by_", 0) != 0) continue;
    auto& means = summary->by[key.substr(3)];
    for (const auto& [name, mean] : groups.items()) means[name];
  }
}

}  // namespace

Json ToJson(const ScoreSummary& summary, bool with_recordings) {
  Json json;
  JsonWriter writer(&json);
  SummaryFields(writer, const_cast<ScoreSummary&>(summary), with_recordings);
  return json;
}

Json ToJson(const Evaluation& evaluation) {
  Json json = ToJson(evaluation.model, true);
  for (const BaselineSummary& baseline : evaluation.baselines) {
    json["baselines"][baseline.key] = ToJson(baseline.summary, false);
  }
  return json;
}

Json ToJson(const CrossValidation& validation) {
  CrossValidation v = validation;
  Json json;
  JsonWriter a(&json);
  a("name", v.predictor);
  SummaryFields(a, v.summary, true);
  PUSHID_FIELDS(a, v, failures, falls);
  a("falls_when_pushed_harder", v.falls_harder);
  if (v.groups) a("group_metrics", ToJson(*v.groups));
  if (v.fits > 0) {
    a("fits", v.fits);
    a("fits_that_settle", v.settling);
    a("fits_that_move_lines_farther_the_harder", v.harder_farther);
    a("slowest_to_settle_m_s", v.slowest_to_settle);
  }
  const ShownMetrics shown = MetricsOf(v.summary.observed, v.summary.bands);
  a.Rows("folds", std::tie(v.folds),
         [&](JsonWriter& row, size_t i) { FoldFields(row, v.folds[i], shown); });
  return json;
}

Json ToJson(const PairedDifference& difference) {
  PairedDifference d = difference;
  Json json;
  JsonWriter a(&json);
  a("from", d.a);
  a("to", d.b);
  a("recordings", d.recordings);
  for (const HipMetric& metric : MetricsOf(d.observed, false)) {
    a(metric.Key().c_str(), d.*metric.value);
    a(metric.ErrorKey().c_str(), d.error.*metric.value);
  }
  PUSHID_FIELDS(a, d, clustered_by, clusters);
  return json;
}

Result<ScoreSummary> ScoresFromJson(const Json& json, const std::string& file) {
  try {
    ScoreSummary summary;
    summary.bands = json.at("mean").contains(kBandMetrics[0].Key());
    ReadGroupNames(json, &summary);
    JsonReader reader(json);
    SummaryFields(reader, summary, true);
    return summary;
  } catch (const std::exception& error) {
    return Error{
        "this is not a file of scores from pushid-evaluate --json_out, or it is damaged: " +
            ReasonOf(error) + "; evaluate again",
        file};
  }
}

Json MeanOfSamples(const std::vector<Json>& samples) {
  Json mean = samples.front();
  if (mean.is_structured()) {
    for (size_t i = 0; i < mean.size(); ++i) {
      const auto at = static_cast<std::ptrdiff_t>(i);
      std::vector<Json> parts;
      for (const Json& sample : samples) parts.push_back(*std::next(sample.begin(), at));
      *std::next(mean.begin(), at) = MeanOfSamples(parts);
    }
    return mean;
  }
  double sum = 0.0;
  for (const Json& sample : samples) {
    if (sample.is_null()) return nullptr;
    if (sample.is_number()) sum += sample.get<double>();
  }
  const bool differ = std::any_of(samples.begin(), samples.end(),
                                  [&mean](const Json& sample) { return sample != mean; });
  return mean.is_number() && differ ? Json(sum / static_cast<double>(samples.size())) : mean;
}

}  // namespace pushid
