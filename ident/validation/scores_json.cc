// ident: scores to JSON and back: each list of entries serves writing and reading alike
// (parameters/json_archive.h). Units stand in the keys. Which metrics there are depends on what was
// asked of the predictor, so the lists of what holds metrics take those that are shown.
#include <nlohmann/json.hpp>
#include <tuple>

#include "ident/model/model_json.h"
#include "ident/parameters/json_archive.h"
#include "ident/validation/crossvalidation.h"
#include "ident/validation/scores_report.h"

namespace pushid {

// Who steps.

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
  // All null where the model has the person stand.
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
    if (a.Has("effect", of.bands)) {
      a("effect", r.effect.mean);
      a("effect_error", r.effect.error);
    }
  }
  a("fell", r.fell);
  // For other readers than ours.
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

}  // namespace pushid
