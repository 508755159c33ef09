// ident: scores from JSON. scores_json.cc is the inverse.
#include <nlohmann/json.hpp>

#include "datasets/files/json_file.h"
#include "ident/parameters/fit_options_json.h"
#include "ident/validation/scores_json.h"
#include "ident/validation/step_score_report.h"

namespace pushid {
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

std::map<std::string, MeanScore> GroupsFrom(const Json& json) {
  std::map<std::string, MeanScore> groups;
  for (const auto& [name, mean] : json.items()) groups[name] = MeanFrom(mean);
  return groups;
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
    summary.by_magnitude = GroupsFrom(json.at("by_magnitude"));
    summary.by_subject = GroupsFrom(json.at("by_subject"));
    summary.by_setting = GroupsFrom(json.at("by_setting"));
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

Result<ScoreSummary> ReadScores(const std::string& path) {
  const Result<JsonDocument> document = ReadJsonDocument(path);
  if (!document.ok()) return document.error();
  return ScoresFromJson(document.value().content, path);
}

}  // namespace pushid
