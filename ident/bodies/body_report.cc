// ident: JSON and tables of body scores.
#include "ident/bodies/body_report.h"

#include <cstdio>
#include <set>

#include "ident/figures/text_table.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;

Json MetricsJson(const BodyMetrics& value) {
  Json json;
  for (int m = 0; m < kNumBodyMetrics; ++m) json[KeyOf(static_cast<BodyMetric>(m))] = value[m];
  return json;
}

Json MeanJson(const BodyMean& mean) {
  Json json = MetricsJson(mean.value);
  for (const BodyMetric m : {kMpjpe, kRelativeMpjpe, kHipAde, kHipFde}) {
    std::string key = KeyOf(m);
    key.insert(key.size() - 2, "_standard_error");  // before _m
    json[key] = mean.error[m];
  }
  json["recordings"] = mean.recordings;
  return json;
}

Json GroupsJson(const std::map<std::string, BodyMean>& groups) {
  Json json = Json::object();
  for (const auto& [name, mean] : groups) json[name] = MeanJson(mean);
  return json;
}

// Keys of `more` into `json`, objects into objects, lists entry by entry.
void Merge(const Json& more, Json* json) {
  if (more.is_object()) {
    if (!json->is_object()) *json = Json::object();
    for (const auto& [key, value] : more.items()) Merge(value, &(*json)[key]);
  } else if (more.is_array() && json->is_array() && more.size() == json->size()) {
    for (size_t i = 0; i < more.size(); ++i) Merge(more[i], &(*json)[i]);
  } else {
    *json = more;
  }
}

std::string Cell(double value, double error = 0.0) {
  char text[64];
  if (error > 0.0) {
    std::snprintf(text, sizeof text, "%.3f +- %.3f", value, error);
  } else {
    std::snprintf(text, sizeof text, "%.3f", value);
  }
  return text;
}

std::vector<std::string> Row(const std::string& name, const BodyMean& mean) {
  const auto& v = mean.value;
  return {name,
          std::to_string(mean.recordings),
          Cell(v[kMpjpe], mean.error[kMpjpe]),
          Cell(v[kHipAde], mean.error[kHipAde]),
          Cell(v[kHipFde]),
          Cell(v[kRelativeMpjpe], mean.error[kRelativeMpjpe]),
          Cell(v[kBoundMpjpe]),
          Cell(v[kMble]),
          Cell(v[kFse])};
}

TextTable NewTable(const std::string& first) {
  return TextTable({first, "recordings", "MPJPE m", "hipADE m", "hipFDE m", "relative m", "bound m",
                    "MBLE m", "FSE cm"},
                   {true, false, false, false, false, false, false, false, false});
}

std::string Spaced(std::string name) {
  for (char& c : name) c = c == '_' ? ' ' : c;
  return name;
}

}  // namespace

Json ToJson(const BodySummary& summary, bool with_recordings) {
  Json json;
  if (with_recordings) {
    json["recordings"] = Json::array();
    for (const BodyScore& score : summary.recordings) {
      Json row = {{"id", score.id}, {"frames", score.frames}};
      if (score.failure.empty()) {
        row.update(MetricsJson(score.value));
      } else {
        row["failure"] = score.failure;
      }
      json["recordings"].push_back(row);
    }
  }
  json["mean"] = MeanJson(summary.mean);
  json["frame_weighted"] = MeanJson(summary.frame_weighted);
  json["by_magnitude"] = GroupsJson(summary.by_magnitude);
  json["by_subject"] = GroupsJson(summary.by_subject);
  json["by_setting"] = GroupsJson(summary.by_setting);
  return json;
}

void AddBodyJson(const BodyEvaluation& evaluation, Json* json) {
  static const std::set<std::string> kAtTop = {"true_pendulum", "recorded"};
  for (const auto& [name, summary] : evaluation) {
    if (name == "restoration") {
      Merge(ToJson(summary, true), json);
    } else if (kAtTop.count(name) == 1) {
      Merge(ToJson(summary, false), &(*json)[name]);
    } else {
      Merge(ToJson(summary, false), &(*json)["baselines"][name]);
    }
  }
}

std::string BodyText(const BodyEvaluation& evaluation) {
  std::string text = "bodies, means over recordings\n";
  TextTable table = NewTable("");
  const auto found = evaluation.find("restoration");
  const bool restores = found != evaluation.end();
  if (restores) {
    table.Add(Row("restoration", found->second.mean));
    table.Add(Row("  frame-weighted", found->second.frame_weighted));
  }
  for (const auto& [name, summary] : evaluation) {
    if (name != "restoration") table.Add(Row(Spaced(name), summary.mean));
  }
  text += table.ToString();
  if (!restores) return text;
  text += "\n";
  TextTable groups = NewTable("restoration by");
  const BodySummary& restored = found->second;
  for (const auto* by : {&restored.by_magnitude, &restored.by_setting, &restored.by_subject}) {
    for (const auto& [name, mean] : *by) groups.Add(Row(name, mean));
  }
  text += groups.ToString();
  for (const BodyScore& score : restored.recordings) {
    if (!score.failure.empty()) text += score.id + ": " + score.failure + "\n";
  }
  return text;
}

}  // namespace pushid
