// ident: scores to JSON and back.
#include <nlohmann/json.hpp>

#include "ident/model/model_json.h"
#include "ident/validation/score_fields.h"
#include "ident/validation/scores_report.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;

// A table of folds: those of a cross-validation.
void FoldFields(JsonWriter& a, FoldScore& fold, const ShownMetrics& shown) {
  a("name", fold.name);
  a("held_out", fold.held_out);
  MetricFields(a, fold, shown);
  a("failures", fold.failures);
  a("falls", fold.falls);
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
  a("failures", v.failures);
  a("falls", v.falls);
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
  a("clustered_by", d.clustered_by);
  a("clusters", d.clusters);
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
