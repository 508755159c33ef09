// ident: scores to JSON and back.
#include <nlohmann/json.hpp>

#include "ident/model/model_json.h"
#include "ident/parameters/fit_options.h"
#include "ident/parameters/json_archive.h"
#include "ident/parameters/option_names.h"
#include "ident/validation/scores_report.h"
#include "ident/validation/steps_report.h"

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
  for (const auto& [key, groups] : summary.by) {
    Json& rows = json["by_" + key] = Json::object();
    for (const auto& [name, mean] : groups) rows[name] = MeanJson(mean, shown);
  }
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

namespace {

using Json = nlohmann::ordered_json;

void ReadMetrics(const Json& json, HipMetrics* metrics) {
  for (const HipMetric& metric : kHipMetrics) metrics->*metric.value = json.at(metric.Key());
  for (const HipMetric& metric : AllHipMetrics()) {
    if (json.contains(metric.Key())) metrics->*metric.value = json.at(metric.Key());
  }
}

MeanScore MeanFrom(const Json& json) {
  MeanScore mean;
  ReadMetrics(json, &mean);
  for (const HipMetric& metric : kHipMetrics) {
    mean.error.*metric.value = json.at(metric.ErrorKey());
  }
  for (const HipMetric& metric : AllHipMetrics()) {
    if (json.contains(metric.Key())) mean.error.*metric.value = json.at(metric.ErrorKey());
  }
  mean.recordings = json.at("recordings");
  mean.clusters = mean.recordings;
  if (json.contains("clustered_by")) {  // added later; they were recordings before
    mean.clustered_by = EnumFrom<ClusterBy>(json, "clustered_by");
    mean.clusters = json.at("clusters");
  }
  return mean;
}

RecordingScore RecordingFrom(const Json& json) {
  RecordingScore score;
  score.id = json.at("id");
  score.frames = json.at("frames");
  if (json.contains("failure")) {
    score.failure = json.at("failure");
  } else {
    ReadMetrics(json, &score);
    score.effect = {json.value("effect", 0.0), json.value("effect_error", 0.0)};
  }
  score.fell = json.at("fell");
  return score;
}

PropagationSummary PropagationFrom(const Json& json) {
  PropagationSummary summary;
  summary.recordings = json.at("recordings");
  summary.movers = json.at("movers");
  summary.bystanders = json.at("bystanders");
  summary.missed_movers = json.at("missed_movers");
  summary.false_movers = json.at("false_movers");
  for (int i = 0; i < kNumPropagationFigures; ++i) {
    const Json& figure = json.at(Info(static_cast<PropagationFigure>(i)).key);
    if (figure.is_null()) continue;  // not known
    summary.figures[i] = {figure.at("value"), figure.at("standard_error"), figure.at("of")};
  }
  return summary;
}

}  // namespace

Result<ScoreSummary> ScoresFromJson(const Json& json, const std::string& file) {
  try {
    ScoreSummary summary;
    summary.observed = json.value("observed", 0);
    summary.bands = json.at("mean").contains(kBandMetrics[0].Key());
    for (const Json& row : json.at("recordings")) summary.recordings.push_back(RecordingFrom(row));
    summary.mean = MeanFrom(json.at("mean"));
    summary.frame_weighted = MeanFrom(json.at("frame_weighted"));
    for (const auto& [key, groups] : json.items()) {
      if (key.rfind("by_", 0) != 0) continue;
      auto& means = summary.by[key.substr(3)];
      for (const auto& [name, mean] : groups.items()) means[name] = MeanFrom(mean);
    }
    if (json.contains("who_steps")) summary.steps = StepScoreFromJson(json.at("who_steps"));
    if (!json.contains("propagation")) return summary;
    const Json& propagation = json.at("propagation");
    summary.propagation = PropagationFrom(propagation);
    if (!propagation.contains("by_setting")) return summary;
    for (const auto& [name, setting] : propagation.at("by_setting").items()) {
      summary.propagation_by_setting[name] = PropagationFrom(setting);
    }
    return summary;
  } catch (const Json::exception& error) {
    return Error{
        "this is not a file of scores from pushid-evaluate --json_out, or it is damaged: " +
            std::string(error.what()) + "; evaluate again",
        file};
  }
}

}  // namespace pushid
