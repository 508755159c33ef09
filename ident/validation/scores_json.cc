// ident: scores as JSON. scores_json_reader.cc is the inverse.
#include "ident/validation/scores_json.h"

#include <nlohmann/json.hpp>

#include "ident/parameters/option_names.h"
#include "ident/results/json_pieces.h"
#include "ident/results/result_json.h"
#include "ident/validation/step_score_report.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;

void AddMetrics(const HipMetrics& metrics, const ShownMetrics& shown, Json* json) {
  for (const HipMetric& metric : shown) (*json)[metric.Key()] = metrics.*metric.value;
}

Json MeanJson(const MeanScore& mean, const ShownMetrics& shown) {
  Json json;
  AddMetrics(mean, shown, &json);
  for (const HipMetric& metric : shown) json[metric.ErrorKey()] = mean.error.*metric.value;
  json["recordings"] = mean.recordings;
  json["clustered_by"] = NameOf(mean.clustered_by);
  json["clusters"] = mean.clusters;
  return json;
}

Json GroupsJson(const std::map<std::string, MeanScore>& groups, const ShownMetrics& shown) {
  Json json = Json::object();
  for (const auto& [name, mean] : groups) json[name] = MeanJson(mean, shown);
  return json;
}

// All null where the model has the person stand.
void AddTiming(const StepTiming& timing, Json* json) {
  (*json)["lift_off_s"] = NumberOrNull(timing.lift_off);
  (*json)["landing_s"] = NumberOrNull(timing.landing);
  (*json)["travel_m"] =
      timing.lift_off ? Json({timing.travel.x(), timing.travel.y()}) : Json(nullptr);
}

Json StepsJson(const std::vector<StepPrediction>& steps) {
  Json people = Json::array();
  for (const StepPrediction& step : steps) {
    people.push_back(
        {{"margin_m", step.margin}, {"probability", step.probability}, {"stepped", step.stepped}});
    if (step.timing) AddTiming(*step.timing, &people.back());
  }
  return people;
}

}  // namespace

Json ToJson(const ScoreSummary& summary, bool with_recordings) {
  Json json;
  const ShownMetrics shown = MetricsOf(summary.observed, summary.bands);
  if (summary.observed > 0) json["observed"] = summary.observed;
  if (with_recordings) {
    json["recordings"] = Json::array();
    for (const RecordingScore& r : summary.recordings) {
      Json row = {{"id", r.id}, {"frames", r.frames}};
      if (r.failure.empty()) {
        AddMetrics(r, shown, &row);
        if (summary.bands) {
          row["effect"] = r.effect.mean;
          row["effect_error"] = r.effect.error;
        }
      } else {
        row["failure"] = r.failure;
      }
      row["fell"] = r.fell;
      if (!r.propagation.people.empty()) row["people"] = PeopleJson(r.propagation);
      if (!r.steps.empty()) row["predicted_steps"] = StepsJson(r.steps);
      json["recordings"].push_back(row);
    }
  }
  json["mean"] = MeanJson(summary.mean, shown);
  json["frame_weighted"] = MeanJson(summary.frame_weighted, shown);
  json["by_magnitude"] = GroupsJson(summary.by_magnitude, shown);
  json["by_subject"] = GroupsJson(summary.by_subject, shown);
  json["by_setting"] = GroupsJson(summary.by_setting, shown);
  if (summary.propagation.recordings > 0) {
    json["propagation"] = ToJson(summary.propagation);
    for (const auto& [name, setting] : summary.propagation_by_setting) {
      json["propagation"]["by_setting"][name] = ToJson(setting);
    }
  }
  if (summary.steps.known()) json["who_steps"] = ToJson(summary.steps);
  return json;
}

Json ToJson(const Evaluation& evaluation) {
  Json json = ToJson(evaluation.model, true);
  json["baselines"] = {{"static", ToJson(evaluation.static_baseline, false)},
                       {"constant_velocity", ToJson(evaluation.constant_velocity, false)}};
  if (evaluation.reanchored) {
    json["baselines"]["reanchored"] = ToJson(*evaluation.reanchored, false);
  }
  return json;
}

Json ToJson(const CrossValidation& validation) {
  Json json = {{"name", validation.predictor}};
  json.update(ToJson(validation.summary, true));
  json["failures"] = validation.failures;
  json["falls"] = validation.falls;
  json["falls_when_pushed_harder"] = validation.falls_harder;
  if (validation.groups) json["group_metrics"] = ToJson(*validation.groups);
  if (validation.fits > 0) {
    json["fits"] = validation.fits;
    json["fits_that_settle"] = validation.settling;
    json["fits_that_move_lines_farther_the_harder"] = validation.harder_farther;
    json["slowest_to_settle_m_s"] = validation.slowest_to_settle;
  }
  json["folds"] = Json::array();
  for (const FoldScore& fold : validation.folds) {
    Json row = {{"name", fold.name}, {"held_out", fold.held_out}};
    AddMetrics(fold, MetricsOf(validation.summary.observed, validation.summary.bands), &row);
    row["failures"] = fold.failures;
    row["falls"] = fold.falls;
    if (fold.behaviour) row["behaviour"] = ToJson(*fold.behaviour);
    if (fold.propagation.recordings > 0) row["propagation"] = ToJson(fold.propagation);
    json["folds"].push_back(row);
  }
  return json;
}

Json ToJson(const PairedDifference& difference) {
  Json json = {{"from", difference.a}, {"to", difference.b}, {"recordings", difference.recordings}};
  for (const HipMetric& metric : MetricsOf(difference.observed, false)) {
    json[metric.Key()] = difference.*metric.value;
    json[metric.ErrorKey()] = difference.error.*metric.value;
  }
  json["clustered_by"] = NameOf(difference.clustered_by);
  json["clusters"] = difference.clusters;
  return json;
}

}  // namespace pushid
