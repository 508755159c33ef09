// ident: scores as JSON.
#include "ident/validation/scores_json.h"

#include "ident/parameters/option_names.h"
#include "ident/results/result_json.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;

Json MeanJson(const MeanScore& mean) {
  return {{"hipADE_m", mean.hip_ade},
          {"hipFDE_m", mean.hip_fde},
          {"hipADE_standard_error_m", mean.hip_ade_error},
          {"hipFDE_standard_error_m", mean.hip_fde_error},
          {"recordings", mean.recordings}};
}

Json GroupsJson(const std::map<std::string, MeanScore>& groups) {
  Json json = Json::object();
  for (const auto& [name, mean] : groups) json[name] = MeanJson(mean);
  return json;
}

}  // namespace

Json ToJson(const ScoreSummary& summary, bool with_recordings) {
  Json json;
  if (with_recordings) {
    json["recordings"] = Json::array();
    for (const RecordingScore& r : summary.recordings) {
      Json row = {{"id", r.id}, {"frames", r.frames}};
      if (r.failure.empty()) {
        row["hipADE_m"] = r.hip_ade;
        row["hipFDE_m"] = r.hip_fde;
      } else {
        row["failure"] = r.failure;
      }
      row["fell"] = r.fell;
      if (!r.propagation.people.empty()) row["people"] = PeopleJson(r.propagation);
      json["recordings"].push_back(row);
    }
  }
  json["mean"] = MeanJson(summary.mean);
  json["frame_weighted"] = MeanJson(summary.frame_weighted);
  json["by_magnitude"] = GroupsJson(summary.by_magnitude);
  json["by_subject"] = GroupsJson(summary.by_subject);
  json["by_setting"] = GroupsJson(summary.by_setting);
  if (summary.propagation.recordings > 0) {
    json["propagation"] = ToJson(summary.propagation);
    for (const auto& [name, setting] : summary.propagation_by_setting) {
      json["propagation"]["by_setting"][name] = ToJson(setting);
    }
  }
  return json;
}

Json ToJson(const Evaluation& evaluation) {
  Json json = ToJson(evaluation.model, true);
  json["baselines"] = {{"static", ToJson(evaluation.static_baseline, false)},
                       {"constant_velocity", ToJson(evaluation.constant_velocity, false)}};
  return json;
}

Json ToJson(const CrossValidation& validation) {
  Json json = {{"name", validation.predictor}};
  json.update(ToJson(validation.summary, true));
  json["failures"] = validation.failures;
  json["falls"] = validation.falls;
  json["falls_when_pushed_harder"] = validation.falls_harder;
  if (validation.fits > 0) {
    json["fits"] = validation.fits;
    json["fits_that_settle"] = validation.settling;
    json["fits_that_move_lines_farther_the_harder"] = validation.harder_farther;
    json["slowest_to_settle_m_s"] = validation.slowest_to_settle;
  }
  json["folds"] = Json::array();
  for (const FoldScore& fold : validation.folds) {
    json["folds"].push_back({{"name", fold.name},
                             {"held_out", fold.held_out},
                             {"hipADE_m", fold.hip_ade},
                             {"hipFDE_m", fold.hip_fde},
                             {"failures", fold.failures},
                             {"falls", fold.falls}});
    if (fold.behaviour) json["folds"].back()["behaviour"] = ToJson(*fold.behaviour);
    if (fold.propagation.recordings == 0) continue;
    json["folds"].back()["propagation"] = ToJson(fold.propagation);
  }
  return json;
}

Json ToJson(const PairedDifference& difference) {
  return {{"from", difference.a},
          {"to", difference.b},
          {"recordings", difference.recordings},
          {"hipADE_m", difference.hip_ade},
          {"hipADE_standard_error_m", difference.hip_ade_error},
          {"hipFDE_m", difference.hip_fde},
          {"hipFDE_standard_error_m", difference.hip_fde_error}};
}

}  // namespace pushid
