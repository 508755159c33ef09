// ident: scores as JSON.
#include "ident/validation/scores_json.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "ident/model/model_json.h"
#include "ident/parameters/json_archive.h"
#include "ident/prediction/predicted_steps.h"

namespace pushid {

std::vector<std::string> FailedRecordings(const ScoreSummary& summary) {
  std::vector<std::string> failed;
  for (const RecordingScore& r : summary.recordings) {
    if (!r.failure.empty()) failed.push_back(r.id + " (" + r.failure + ")");
  }
  return failed;
}

Metrics MeanWithStatic(const ScoreSummary& summary) {
  Metrics sum = Metrics::Zero();
  for (const RecordingScore& r : summary.recordings) sum += r.value;
  return sum / std::max<double>(1.0, static_cast<double>(summary.recordings.size()));
}

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
    a.OrNull(Info(static_cast<PropagationFigure>(i)).key,
             mean.known() ? std::optional(mean) : std::nullopt);
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
  a("impulse_passed_on_N_s", p.impulse_on);
  a("contact_work_J", p.contact_work);
}

namespace {

using Json = nlohmann::ordered_json;

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

void AddSummary(const ScoreSummary& s, bool with_recordings, Json* json) {
  const MetricList metrics = MetricsOf(s.observed, s.bands);
  if (s.observed > 0) (*json)["observed"] = s.observed;
  if (with_recordings) (*json)["recordings"] = Json::array();
  for (size_t i = 0; with_recordings && i < s.recordings.size(); ++i) {
    const RecordingScore& r = s.recordings[i];
    Json row = ScoreJson(r, metrics);
    row["fell"] = r.fell;
    if (!r.propagation.people.empty()) row["people"] = JsonOf(r.propagation.people);
    if (!r.steps.empty()) row["predicted_steps"] = JsonOf(r.steps);
    (*json)["recordings"].push_back(std::move(row));
  }
  AddMeans(s, metrics, true, json);
  if (!FailedRecordings(s).empty()) {
    Json& with_static = (*json)["mean_with_failures_as_static"] = Json::object();
    AddMetrics(MeanWithStatic(s), TableMetrics(s.observed), &with_static);
  }
  if (s.propagation.recordings > 0) {
    Json& propagation = (*json)["propagation"] = JsonOf(s.propagation);
    if (!s.propagation_by_setting.empty()) {
      propagation["by_setting"] = JsonOf(s.propagation_by_setting);
    }
  }
  if (s.steps.known()) (*json)["who_steps"] = JsonOf(s.steps);
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
  (*json)["frame_weighted"] = MeanJson(means.frame_weighted, metrics, with_clusters);
  for (const auto& [key, groups] : means.by) {
    Json& by = (*json)["by_" + key] = Json::object();
    for (const auto& [name, mean] : groups) by[name] = MeanJson(mean, metrics, with_clusters);
  }
  if (!means.without_label.empty()) (*json)["without_label"] = means.without_label;
}

Json ToJson(const ScoreSummary& summary, bool with_recordings) {
  Json json;
  AddSummary(summary, with_recordings, &json);
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
  AddSummary(v.summary, true, &json);
  json["failures"] = v.failures;
  json["falls"] = v.falls;
  json["falls_when_pushed_harder"] = v.falls_harder;
  if (v.groups) json["group_metrics"] = ToJson(*v.groups);
  if (v.fits > 0) {
    json["fits"] = v.fits;
    json["fits_that_settle"] = v.settling;
    json["fits_that_move_lines_farther_the_harder"] = v.harder_farther;
    json["slowest_to_settle_m_s"] = NumberJson(v.slowest_to_settle);
  }
  json["folds"] = Json::array();
  for (const FoldScore& fold : v.folds) {
    Json row = {{"name", fold.name}, {"held_out", fold.held_out}};
    AddMetrics(fold.value, MetricsOf(v.summary.observed, v.summary.bands), &row);
    row["failures"] = fold.failures;
    row["falls"] = fold.falls;
    if (fold.behaviour) row["behaviour"] = ToJson(*fold.behaviour);
    if (fold.propagation.recordings > 0) row["propagation"] = JsonOf(fold.propagation);
    json["folds"].push_back(std::move(row));
  }
  return json;
}

Json ToJson(const PairedDifference& d) {
  Json json = {{"from", d.a}, {"to", d.b}, {"recordings", d.recordings}};
  for (MetricId m : MetricsOf(d.observed, false)) {
    json[kMetrics[m].Key()] = NumberJson(d.value[m]);
    json[kMetrics[m].ErrorKey()] = NumberJson(d.error[m]);
  }
  json["clustered_by"] = NameOf(d.clustered_by);
  json["clusters"] = d.clusters;
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

}  // namespace pushid
