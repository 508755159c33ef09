#include "ident/validation/scores_report.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <nlohmann/json.hpp>

#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "ident/model/model_json.h"
#include "ident/parameters/json_archive.h"
#include "ident/prediction/predicted_steps.h"

namespace pushid {

void Fields(JsonArchive& a, StepFifth& f) { PUSHID_FIELDS(a, f, tracks, predicted, observed); }

void Fields(JsonArchive& a, StepScore& s) {
  PUSHID_FIELDS(a, s, tracks, stepped, people, brier, brier_error, auc, auc_error, fifths);
  if (s.lift_off.people == 0) return;
  a.Group("lift_off", [&](auto& g) {
    g("people", s.lift_off.people);
    g("median_error_s", s.lift_off.median);
    g("mean_absolute_error_s", s.lift_off.mean_absolute);
    g("landed", s.lift_off.landed);
    g("place_error_m", s.lift_off.place);
  });
}

void Fields(JsonArchive& a, StepPrediction& s) {
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

void Fields(JsonArchive& a, PropagationMean& m) {
  a("value", m.value);
  a("standard_error", m.error);
  a("of", m.weight);
}

void Fields(JsonArchive& a, PropagationSummary& s) {
  a("recordings", s.recordings);
  a("onset_distance_m", kOnsetDistance);
  PUSHID_FIELDS(a, s, movers, bystanders, missed_movers, false_movers);
  for (int i = 0; i < kNumPropagationFigures; ++i) {
    const PropagationMean& mean = s.figures[i];
    a.OrNull(kPropagationFigures[i].key, mean.known() ? std::optional(mean) : std::nullopt);
  }
  a.OrNull("speed_measured_m_per_s", Speed(s.figures[kSlownessMeasured]));
  a.OrNull("speed_predicted_m_per_s", Speed(s.figures[kSlownessPredicted]));
}

void Fields(JsonArchive& a, PersonPropagation& p) {
  a("rank", p.rank);
  a("distance_m", p.distance);
  a("onset_measured_frame", p.onset_measured);
  a("onset_predicted_frame", p.onset_predicted);
  a("peak_momentum_measured_N_s", p.peak_momentum_measured);
  a("peak_momentum_predicted_N_s", p.peak_momentum_predicted);
}

namespace {

using Json = nlohmann::ordered_json;

// "single_X05_00 (fell at 0.4 s)" of each recording without a prediction.
std::vector<std::string> FailedRecordings(const ScoreSummary& summary) {
  std::vector<std::string> failed;
  for (const RecordingScore& r : summary.recordings) {
    if (!r.failure.empty()) failed.push_back(r.id + " (" + r.failure + ")");
  }
  return failed;
}

// The mean over all recordings; one without a prediction has the error of the static baseline.
Metrics MeanWithStatic(const ScoreSummary& summary) {
  Metrics sum = Metrics::Zero();
  for (const RecordingScore& r : summary.recordings) sum += r.value;
  return sum / std::max<double>(1.0, static_cast<double>(summary.recordings.size()));
}

void AddMetrics(const Metrics& values, const MetricList& metrics, Json* json) {
  for (MetricId m : metrics) (*json)[kMetrics[m].Key()] = NumberJson(values[m]);
}

Json MeanJson(const MeanScore& mean, const MetricList& metrics, bool with_clusters) {
  Json json;
  AddMetrics(mean.value, metrics, &json);
  for (MetricId m : metrics) {
    if (kMetrics[m].with_error) json[kMetrics[m].ErrorKey()] = NumberJson(mean.error[m]);
  }
  json["recordings"] = mean.recordings;
  if (!with_clusters) return json;
  json["clustered_by"] = NameOf(mean.clustered_by);
  json["clusters"] = mean.clusters;
  return json;
}

// A single recording has no error.
std::string ScoreText(double value, double error, const MeanScore& mean) {
  if (mean.recordings == 0) return "-";
  return Rounded(value, 3) + (mean.recordings > 1 ? " +- " + Rounded(error, 2) : "");
}

std::string MeanText(const MeanScore& mean, const MetricList& shown) {
  std::vector<std::string> texts;
  for (MetricId m : shown) texts.push_back(ScoreText(mean.value[m], mean.error[m], mean));
  return Joined(texts, " / ");
}

// Cells without errors; "-" where there is no score.
std::vector<std::string> PlainCells(const Metrics& values, const MetricList& shown,
                                    bool known = true) {
  std::vector<std::string> cells;
  for (MetricId m : shown) cells.push_back(known ? Rounded(values[m], 3) : "-");
  return cells;
}

// The heads of columns of numbers.
std::vector<std::string> Titles(const MetricList& shown) {
  std::vector<std::string> titles;
  for (MetricId m : shown) titles.push_back(">" + kMetrics[m].Title());
  return titles;
}

// "hipADE / hipFDE in m"
std::string NamesText(const MetricList& shown) {
  std::vector<std::string> names;
  for (MetricId m : shown) names.push_back(kMetrics[m].name);
  return Joined(names, " / ") + " in " + kMetrics[shown.front()].unit;
}

// A row of a table out of its parts.
std::vector<std::string> Row(std::initializer_list<std::vector<std::string>> parts) {
  std::vector<std::string> row;
  for (const auto& cells : parts) row.insert(row.end(), cells.begin(), cells.end());
  return row;
}

std::string ErrorsText(const ScoreSummary& summary) {
  if (summary.mean.clusters < 2) return "";
  const bool people = summary.mean.clustered_by == ClusterBy::kSubject;
  return "+-: standard errors over " +
         ClustersText(summary.mean.clustered_by, summary.mean.clusters) +
         (people ? "; within one person, over recordings" : "") + "\n";
}

std::string ObservedText(const ScoreSummary& summary) {
  if (summary.observed == 0) return "";
  return "the first " + CountText(summary.observed, "frame was", "frames were") +
         " seen, which have no error; after_hipADE: mean over the others\n";
}

// Coverage of predictions that are distributions.
std::string BandsText(const std::string& name, const ScoreSummary& summary) {
  if (!summary.bands) return "";
  const auto text = [&summary](int metric) {
    return ScoreText(summary.mean.value[metric], summary.mean.error[metric], summary.mean);
  };
  return name + ": 90 % bands hold " + text(kInside90) + " (x) and " + text(kInside90 + 1) +
         " (y) of the predicted frames of the pushed person, 50 % " + text(kInside50) + " and " +
         text(kInside50 + 1) + "; CRPS " + text(kCrps) + " m\n";
}

// A row with the mean of each predictor. errors: with standard errors of all of them, otherwise of
// the first alone.
std::vector<std::string> MeansRow(const std::string& name, const std::vector<MeanScore>& means,
                                  const MetricList& shown, bool errors) {
  std::vector<std::string> row = {name};
  for (size_t i = 0; i < means.size(); ++i) {
    const bool known = means[i].recordings > 0;
    row.push_back(errors || i == 0 ? MeanText(means[i], shown)
                                   : Joined(PlainCells(means[i].value, shown, known), " / "));
  }
  return row;
}

// Adds a row for each group. only: groups by this label; empty: by all labels.
void AddGroups(const std::vector<const ScoreSummary*>& summaries, const MetricList& shown,
               bool errors, const std::string& only, TextTable* table) {
  for (const auto& [key, groups] : summaries[0]->by) {
    if (groups.size() < 2 || (!only.empty() && key != only)) continue;
    const bool one_of_several = key == kSubjectUnit && summaries[0]->propagation.recordings > 0;
    const std::string title = key == kMagnitudeLabel ? "strength"
                              : one_of_several       ? "pushed person"
                                                     : key;
    for (const auto& group : groups) {
      std::vector<MeanScore> means;
      for (const ScoreSummary* one : summaries) {  // a baseline may fail in all of a group
        const auto found = one->by.at(key).find(group.first);
        means.push_back(found == one->by.at(key).end() ? MeanScore() : found->second);
      }
      const std::string number = std::to_string(means[0].recordings);
      table->Add(MeansRow(title + " " + group.first + " (" + number + ")", means, shown, errors));
    }
  }
}

std::string FigureText(const PropagationMean& mean) {
  if (!mean.known()) return "-";
  return WithError(mean.value, mean.error);
}

// "3.2 +- 0.3", "-" where nothing is known, "undefined" where all begin at once.
std::string SpeedText(const PropagationMean& slowness) {
  const std::optional<PropagationMean> speed = Speed(slowness);
  return speed ? FigureText(*speed) : (slowness.known() ? "undefined" : "-");
}

std::string FailuresText(const std::string& name, const ScoreSummary& summary,
                         const MetricList& shown) {
  const std::vector<std::string> failed = FailedRecordings(summary);
  if (failed.empty()) return "";
  return name + " fails in " + std::to_string(failed.size()) + " of " +
         std::to_string(summary.recordings.size()) +
         " recordings, which are in no mean: " + ListOfNames(failed, 3, "recordings") + "; " +
         NamesText(shown) + " with those of the static baseline there: " +
         Joined(PlainCells(MeanWithStatic(summary), shown), " / ") + "\n";
}

// Onset errors of the people who move in both say little if most movers are missed: a model that
// moves only the pushed person would look best.
bool MostMissed(const PropagationSummary& s) { return s.missed_movers > 0.5 * s.movers; }

bool OfThoseWhoMoveInBoth(int figure) {
  return figure == kOnsetError || figure == kOnsetErrorReached || figure == kOnsetBias;
}

std::string CountsText(double part, double whole) {
  return Rounded(part, 3) + " of " + Rounded(whole, 4);
}

// Means of the model and of the baselines; all: by every label.
TextTable MeansTable(const Evaluation& evaluation, bool all) {
  const ScoreSummary& m = evaluation.model;
  const MetricList shown = TableMetrics(m.observed);
  std::vector<std::string> header = {NamesText(shown), "model"};
  std::vector<const ScoreSummary*> summaries = {&m};
  for (const BaselineSummary& baseline : evaluation.baselines) {
    header.push_back(baseline.name);
    summaries.push_back(&baseline.summary);
  }
  TextTable table(header);
  std::vector<MeanScore> means;
  for (const ScoreSummary* one : summaries) means.push_back(one->mean);
  table.Add(MeansRow("mean over recordings", means, shown, false));
  const bool strengths = m.by.count(kMagnitudeLabel) > 0;
  const std::string first = strengths ? kMagnitudeLabel : m.by.empty() ? "" : m.by.begin()->first;
  AddGroups(summaries, shown, false, all ? "" : first, &table);
  return table;
}

TextTable RecordingsTable(const Evaluation& evaluation) {
  const MetricList shown = TableMetrics(evaluation.model.observed);
  std::vector<std::string> baselines;
  for (const BaselineSummary& one : evaluation.baselines) baselines.push_back(">" + one.name);
  TextTable table(Row({{"recording", ">frames"}, Titles(shown), baselines, {""}}));
  for (size_t i = 0; i < evaluation.model.recordings.size(); ++i) {
    const RecordingScore& r = evaluation.model.recordings[i];
    for (size_t k = 0; k < baselines.size(); ++k) {
      baselines[k] = PlainCells(evaluation.baselines[k].summary.recordings[i].value, shown)[0];
    }
    table.Add(Row({{r.id, std::to_string(r.frames)},
                   PlainCells(r.value, shown, r.failure.empty()),
                   baselines,
                   {r.failure}}));
  }
  return table;
}

// "The model's error is 0.49 times that of the best baseline (constant velocity)."
std::string RatioText(const Evaluation& evaluation) {
  const MetricId metric = TableMetrics(evaluation.model.observed).front();
  // The mean of all recordings, so that a failure in a hard one makes no model better.
  const auto error = [metric](const ScoreSummary& s) { return MeanWithStatic(s)[metric]; };
  const BaselineSummary* best = nullptr;
  for (const BaselineSummary& baseline : evaluation.baselines) {
    if (baseline.summary.mean.recordings == 0) continue;
    if (best == nullptr || error(baseline.summary) < error(best->summary)) best = &baseline;
  }
  if (evaluation.model.mean.recordings == 0) return "The model predicts no recording.";
  if (best == nullptr) return "";
  const double ratio = error(evaluation.model) / error(best->summary);
  return "The model's error is " + Rounded(ratio, 2) + " times that of the best baseline (" +
         best->name + ")" + (ratio < 1.0 ? "." : ": do not predict with it.");
}

double HalfInterval95(const PairedDifference& d) {
  return StudentQuantile95(d.clusters - 1.0) * d.error[kHipAde];
}

// A sentence that compares two configurations: they differ if the 95 % interval of their
// difference excludes zero.
std::string ConclusionText(const PairedDifference& d) {
  if (d.clusters < 2) return d.b + " cannot be compared with " + d.a + ".";
  const Metric& metric = kMetrics[kHipAde];
  const double change = d.value[kHipAde], error = d.error[kHipAde];
  const std::string by = Rounded(std::abs(change), 2) + " +- " + Rounded(error, 2) + " " +
                         metric.unit + " of " + metric.name;
  const double half = HalfInterval95(d);
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

// The candidates with their differences from the first; all: how many fits settle as well.
TextTable CandidatesTable(const std::vector<CrossValidation>& candidates, bool all) {
  const CrossValidation& own = candidates.front();
  const MetricList shown = TableMetrics(own.summary.observed);
  std::vector<std::string> header = {"held out", NamesText(shown),
                                     kMetrics[kHipAde].name + (" - " + own.predictor + ", 95 %"),
                                     ">failed", ">fell"};
  if (all) header.push_back(">settle");
  TextTable table(header);
  for (const CrossValidation& one : candidates) {
    const PairedDifference difference = Compare(own, one);
    const bool compared = &one != &own && difference.clusters > 1;
    std::vector<std::string> row = {one.predictor, MeanText(one.summary.mean, shown),
                                    compared ? Rounded(difference.value[kHipAde], 2) + " +- " +
                                                   Rounded(HalfInterval95(difference), 2)
                                             : "",
                                    std::to_string(one.failures), std::to_string(one.falls)};
    if (all) row.push_back(one.fits > 0 ? CountsText(one.settling, one.fits) : "");
    table.Add(row);
  }
  return table;
}

}  // namespace

Json ScoreJson(const Score& score, const MetricList& metrics) {
  Json json = {{"id", score.id}, {"frames", score.frames}};
  if (score.failure.empty()) {
    AddMetrics(score.value, metrics, &json);
  } else {
    json["failure"] = score.failure;
  }
  return json;
}

void AddMeans(const ScoreMeans& means, const MetricList& metrics, bool with_clusters, Json* json) {
  (*json)["mean"] = MeanJson(means.mean, metrics, with_clusters);
  for (const auto& [key, groups] : means.by) {
    Json& by = (*json)["by_" + key] = Json::object();
    for (const auto& [name, mean] : groups) by[name] = MeanJson(mean, metrics, with_clusters);
  }
  if (!means.without_label.empty()) (*json)["without_label"] = means.without_label;
}

Json ToJson(const ScoreSummary& s, bool with_recordings) {
  Json json;
  const MetricList metrics = MetricsOf(s.observed, s.bands);
  if (s.observed > 0) json["observed"] = s.observed;
  if (with_recordings) json["recordings"] = Json::array();
  for (size_t i = 0; with_recordings && i < s.recordings.size(); ++i) {
    const RecordingScore& r = s.recordings[i];
    Json row = ScoreJson(r, metrics);
    row["fell"] = r.fell;
    if (!r.propagation.people.empty()) row["people"] = JsonOf(r.propagation.people);
    if (!r.steps.empty()) row["predicted_steps"] = JsonOf(r.steps);
    json["recordings"].push_back(std::move(row));
  }
  AddMeans(s, metrics, true, &json);
  if (!FailedRecordings(s).empty()) {
    Json& with_static = json["mean_with_failures_as_static"] = Json::object();
    AddMetrics(MeanWithStatic(s), TableMetrics(s.observed), &with_static);
  }
  if (s.propagation.recordings > 0) json["propagation"] = JsonOf(s.propagation);
  if (s.steps.known()) json["who_steps"] = JsonOf(s.steps);
  return json;
}

Json ToJson(const Evaluation& evaluation) {
  Json json = ToJson(evaluation.model, true);
  for (const BaselineSummary& baseline : evaluation.baselines) {
    json["baselines"][baseline.key] = ToJson(baseline.summary, false);
  }
  return json;
}

Json ToJson(const CrossValidation& v) {
  Json json = {{"name", v.predictor}};
  json.update(ToJson(v.summary, true));
  json["failures"] = v.failures;
  json["falls"] = v.falls;
  if (v.fits > 0) {
    json["fits"] = v.fits;
    json["fits_that_settle"] = v.settling;
    json["slowest_to_settle_m_s"] = NumberJson(v.slowest_to_settle);
  }
  json["folds"] = Json::array();
  for (const FoldScore& fold : v.folds) {
    Json row = {{"name", fold.name}, {"held_out", fold.held_out}};
    AddMetrics(fold.value, MetricsOf(v.summary.observed, v.summary.bands), &row);
    row["failures"] = fold.failures;
    row["falls"] = fold.falls;
    if (fold.behaviour) row["behaviour"] = ToJson(*fold.behaviour);
    json["folds"].push_back(std::move(row));
  }
  return json;
}

Json ToJson(const PairedDifference& d) {
  Json json = {{"from", d.a}, {"to", d.b}};
  json.update(MeanJson(d, MetricsOf(d.observed, false), true));
  return json;
}

Result<Metrics> MeanMetrics(const Json& json, const MetricList& metrics, const std::string& file) {
  try {
    Metrics values = Metrics::Zero();
    for (MetricId m : metrics) values[m] = NumberFrom(json.at("mean").at(kMetrics[m].Key()));
    return values;
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

std::string EvaluationText(const Evaluation& evaluation, bool per_recording) {
  const ScoreSummary& m = evaluation.model;
  std::string text = TextLines(FailuresText("the model", m, TableMetrics(m.observed)));
  if (per_recording) text += RecordingsTable(evaluation).ToString() + "\n";
  text += MeansTable(evaluation, true).ToString() +
          TextLines(WithoutLabelText(m.without_label) + ErrorsText(m) + ObservedText(m) +
                    BandsText("model", m));
  if (m.steps.known()) text += "\n" + StepScoresText({{"model", &m.steps}});
  if (m.propagation.recordings == 0) return text;
  return text + "\n" +
         PropagationText(
             {{"model", &m.propagation},
              {"constant velocity", &evaluation.Baseline("constant_velocity").propagation}});
}

Screen EvaluationScreen(const Evaluation& evaluation) {
  const ScoreSummary& m = evaluation.model;
  Screen screen{CountText(m.recordings.size(), "recording") + ", predicted and as recorded"};
  screen.verdict = FailuresText("the model", m, TableMetrics(m.observed)) + RatioText(evaluation);
  screen.tables = {MeansTable(evaluation, false)};
  screen.paragraphs = {ErrorsText(m), ObservedText(m), BandsText("model", m)};
  if (m.steps.known()) {
    screen.paragraphs.push_back("who steps: AUC " + Rounded(m.steps.auc, 3) + ", Brier score " +
                                Rounded(m.steps.brier, 2));
  }
  const std::string travels = TravelText(m.propagation);
  screen.paragraphs.push_back((travels.empty() ? "" : "how pushes travel: ") + travels);
  screen.rest = "the rest: --details; recordings: --per_recording; all numbers: --json_out";
  return screen;
}

std::string TravelText(const PropagationSummary& p) {
  if (p.recordings == 0 || !p.figures[kSlownessMeasured].known()) return "";
  std::string text = "in " + std::to_string(std::lround(p.figures[kSlownessMeasured].weight)) +
                     " recordings the onset of motion propagated at " +
                     SpeedText(p.figures[kSlownessMeasured]) +
                     " m/s (predicted: " + SpeedText(p.figures[kSlownessPredicted]) + ")";
  const PropagationMean &measured = p.figures[kMomentumMeasured],
                        &predicted = p.figures[kMomentumPredicted];
  if (measured.known() && predicted.known()) {
    text += "; the momentum of each person was " + Rounded(measured.value, 2) +
            " times that of the previous one (predicted: " + Rounded(predicted.value, 2) + ")";
  }
  return text + "; the model misses " + Rounded(p.missed_movers, 4) + " of the " +
         Rounded(p.movers, 4) + " people who moved.";
}

std::string PropagationText(const NamedValues<PropagationSummary>& summaries) {
  using S = PropagationSummary;
  const auto any = [&summaries](const auto& holds) {
    return std::any_of(summaries.begin(), summaries.end(),
                       [&holds](const auto& one) { return holds(*one.second); });
  };
  ColumnTable<S> table("propagation", summaries);
  table.Add("recordings", [](const S& s) { return std::to_string(s.recordings); });
  table.Add("missed movers", [](const S& s) { return CountsText(s.missed_movers, s.movers); });
  table.Add("false movers", [](const S& s) { return CountsText(s.false_movers, s.bystanders); });
  for (int i = 0; i < kNumPropagationFigures; ++i) {
    if (!any([i](const S& s) { return s.figures[i].known(); })) continue;
    table.Add(kPropagationFigures[i].title, [i](const S& s) {
      return OfThoseWhoMoveInBoth(i) && MostMissed(s) ? "-" : FigureText(s.figures[i]);
    });
    if (i == kSlownessMeasured || i == kSlownessPredicted) {
      table.Add("  speed, m/s", [i](const S& s) { return SpeedText(s.figures[i]); });
    }
  }
  return table.ToString() +
         (any(MostMissed) ? "onset error -: most movers are missed; see the row that counts them\n"
                          : "");
}

std::string CrossValidationText(const std::vector<CrossValidation>& candidates) {
  std::string text;
  if (candidates.empty()) return text;
  const bool groups = candidates[0].summary.propagation.recordings > 0;
  const MetricList shown = TableMetrics(candidates[0].summary.observed);
  for (const CrossValidation& candidate : candidates) {
    text += FailuresText(candidate.predictor, candidate.summary, shown);
  }
  using Cells = std::vector<std::string>;
  TextTable folds(Row({{"fold", ">held out"}, Titles(shown), {">failed", ">fell"}}));
  for (const FoldScore& fold : candidates[0].folds) {
    folds.Add(Row({{fold.name, std::to_string(fold.held_out)},
                   PlainCells(fold.value, shown),
                   {std::to_string(fold.failures), std::to_string(fold.falls)}}));
  }
  text += folds.ToString() + "\n";
  std::string said = ErrorsText(candidates[0].summary) + ObservedText(candidates[0].summary);
  for (const CrossValidation& candidate : candidates) {
    said += BandsText(candidate.predictor, candidate.summary);
  }
  for (size_t i = 1; i < candidates.size(); ++i) {
    said += ConclusionText(Compare(candidates[0], candidates[i])) + "\n";
  }
  Cells header = {NamesText(shown) + ", held out"};
  std::vector<const ScoreSummary*> summaries;
  NamedValues<StepScore> steps;
  NamedValues<PropagationSummary> travels;
  for (const CrossValidation& candidate : candidates) {
    header.push_back(candidate.predictor);
    summaries.push_back(&candidate.summary);
    steps.emplace_back(candidate.predictor, &candidate.summary.steps);
    travels.emplace_back(candidate.predictor, &candidate.summary.propagation);
  }
  TextTable by_group(header);  // empty where no label of --group_by tells recordings apart
  AddGroups(summaries, shown, true, "", &by_group);
  const std::string who_steps = StepScoresText(steps);
  text += CandidatesTable(candidates, true).ToString() + TextLines(said) +
          (by_group.empty() ? "" : "\n" + by_group.ToString()) +
          (who_steps.empty() ? "" : "\n" + who_steps);
  return groups ? text + "\n" + PropagationText(travels) : text;
}

Screen CrossValidationScreen(const std::vector<CrossValidation>& candidates) {
  const CrossValidation& own = candidates.front();
  const MetricList shown = TableMetrics(own.summary.observed);
  Screen screen{CountText(own.summary.mean.recordings, "recording") + " in " +
                CountText(own.folds.size(), "fold") + ", each predicted by fits without it"};
  const CrossValidation* rival = nullptr;  // the best of the others
  for (const CrossValidation& one : candidates) {
    if (&one == &own || Compare(own, one).clusters < 2) continue;
    const auto error = [](const CrossValidation& v) { return MeanWithStatic(v.summary)[kHipAde]; };
    if (rival == nullptr || error(one) < error(*rival)) rival = &one;
  }
  for (const CrossValidation& one : candidates) {
    screen.verdict += FailuresText(one.predictor, one.summary, shown);
  }
  if (rival != nullptr) screen.verdict += ConclusionText(Compare(own, *rival));
  screen.tables = {CandidatesTable(candidates, false)};
  screen.paragraphs = {ErrorsText(own.summary), ObservedText(own.summary)};
  for (const CrossValidation& one : candidates) {
    screen.paragraphs.push_back(BandsText(one.predictor, one.summary));
  }
  screen.rest = "the rest: --details; all numbers: --json_out";
  return screen;
}

}  // namespace pushid
