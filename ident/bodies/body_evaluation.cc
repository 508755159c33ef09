// ident: scores of restorations and baselines.
#include "ident/bodies/body_evaluation.h"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <set>

#include "ident/figures/text_table.h"
#include "ident/model/model_rollout.h"
#include "ident/prediction/online_predictor.h"
#include "models/learned_terms.h"

namespace pushid {

BodyScore FailedBodies(const BodyRecording& recording, const std::string& failure) {
  BodyScore score;
  score.id = recording.pendulum.id;
  score.frames = recording.num_frames();
  score.failure = failure;
  return score;
}

std::vector<BodyMotion> RestoreBodies(const Restoration& restoration,
                                      const PostprocessOptions& options,
                                      const std::vector<RestorationInput>& people) {
  std::vector<BodyMotion> motions = restoration.Restore(people);
  for (size_t n = 0; n < people.size(); ++n) Finish(people[n], options, &motions[n]);
  return motions;
}

std::vector<BodyMotion> StaticBodies(const BodyRecording& recording, int observed) {
  std::vector<BodyMotion> motions;
  for (const BodyMotion& body : recording.bodies) {
    BodyMotion motion(body.begin(), body.begin() + std::max(1, observed));
    motion.resize(body.size(), Pose(motion.back()));
    motions.push_back(std::move(motion));
  }
  return motions;
}

std::vector<BodyMotion> ConstantVelocityBodies(const BodyRecording& recording, int observed) {
  const int known = observed > 0 ? observed - 1 : recording.pendulum.scene.LastPushEnd();
  const int last = std::min(known, recording.num_frames() - 1);
  std::vector<BodyMotion> motions;
  for (const BodyMotion& body : recording.bodies) {
    BodyMotion motion(body.begin(), body.begin() + last + 1);
    Eigen::Vector3d step = Eigen::Vector3d::Zero();
    if (last > 0) step = (body[last] - body[last - 1]).col(0);
    while (motion.size() < body.size()) {
      const Pose next = motion.back().colwise() + step;
      motion.push_back(next);
    }
    motions.push_back(std::move(motion));
  }
  return motions;
}

void ScoreRestoration(const IdentifiedModel& model, const Restoration& restoration,
                      const PostprocessOptions& options, const BodyRecording& recording,
                      BodyScores* scores, int observed, ForecastUse use) {
  const auto add = [&](const char* name, const std::vector<BodyMotion>& bodies) {
    (*scores)[name].push_back(ScoreBodies(recording, bodies, std::max(1, observed)));
  };
  const std::vector<RestorationInput> recorded =
      RecordedPeople(recording, RodMoves(model.options), observed);
  add("true_pendulum", RestoreBodies(restoration, options, recorded));
  add("static", StaticBodies(recording, observed));
  add("constant_velocity", ConstantVelocityBodies(recording, observed));
  add("recorded", recording.bodies);
  const Result<Prediction> predicted = PredictFrom(model, recording.pendulum, observed, 0, use);
  if (!predicted.ok() || !predicted.value().status.ok) {
    const std::string failure =
        predicted.ok() ? OutsideText(predicted.value().status) : predicted.error().message;
    std::vector<const char*> names = {"restoration", "rigid"};
    if (observed > 0) names.push_back("restoration_all_frames");
    for (const char* name : names) (*scores)[name].push_back(FailedBodies(recording, failure));
    return;
  }
  const Prediction& prediction = predicted.value();
  const std::vector<RestorationInput> people = PredictedPeople(recording, prediction);
  const std::vector<BodyMotion> restored = RestoreBodies(restoration, options, people);
  add("restoration", restored);
  if (observed > 0) {
    (*scores)["restoration_all_frames"].push_back(ScoreBodies(recording, restored));
  }
  add("rigid", RigidRestoration().Restore(people));
}

BodyEvaluation SummarizeAll(const std::vector<BodyRecording>& recordings, const BodyScores& scores,
                            const LabelKeys& group_by) {
  BodyEvaluation evaluation;
  for (const auto& [name, of_name] : scores) {
    evaluation[name] = SummarizeBodies(recordings, of_name, group_by);
  }
  return evaluation;
}

BodyEvaluation SummarizeAll(const std::vector<BodyRecording>& recordings,
                            const std::vector<std::map<std::string, BodyScore>>& by_recording) {
  BodyScores all;
  for (const auto& scores : by_recording) {
    for (const auto& [name, score] : scores) all[name].push_back(score);
  }
  return SummarizeAll(recordings, all);
}

namespace {

using Json = nlohmann::ordered_json;

Json MetricsJson(const BodyMetrics& value) {
  Json json;
  for (int m = 0; m < kNumBodyMetrics; ++m) json[kBodyMetrics[m].Key()] = value[m];
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
  std::vector<std::string> row = {name, std::to_string(mean.recordings)};
  for (int m = 0; m < kNumBodyMetrics; ++m) {
    row.push_back(Cell(mean.value[m], kBodyMetrics[m].with_error ? mean.error[m] : 0.0));
  }
  return row;
}

TextTable NewTable(const std::string& first) {
  std::vector<std::string> header = {first, "recordings"};
  for (const BodyMetricRow& metric : kBodyMetrics) header.push_back(metric.Title());
  return TextTable::OfNumbers(header);
}

std::string Spaced(std::string name) {
  for (char& c : name) c = c == '_' ? ' ' : c;
  return name;
}

// How groups move, where there are any.
std::string GroupsText(const BodyEvaluation& evaluation) {
  std::vector<GroupMetricsRow> rows;
  for (const auto& [name, summary] : evaluation) {
    if (summary.groups) rows.push_back({Spaced(name), &*summary.groups});
  }
  return rows.empty() ? "" : "\n" + GroupMetricsText(rows);
}

}  // namespace

Json MeanJson(const BodyMean& mean) {
  Json json = MetricsJson(mean.value);
  for (int m = 0; m < kNumBodyMetrics; ++m) {
    if (kBodyMetrics[m].with_error) json[kBodyMetrics[m].ErrorKey()] = mean.error[m];
  }
  json["recordings"] = mean.recordings;
  return json;
}

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
  for (const auto& [key, groups] : summary.by) {
    Json& rows = json["by_" + key] = Json::object();
    for (const auto& [name, mean] : groups) rows[name] = MeanJson(mean);
  }
  if (!summary.without_label.empty()) json["without_label"] = summary.without_label;
  if (summary.groups) json["group_metrics"] = ToJson(*summary.groups);
  json["errors_at"] = Json::array();
  for (size_t i = 0; i < summary.at.size(); ++i) {
    const TimedMean& at = summary.at[i];
    const auto metres = [&at](double value) { return at.recordings > 0 ? Json(value) : Json(); };
    json["errors_at"].push_back({{"seconds", kErrorSeconds[i]},
                                 {"recordings", at.recordings},
                                 {"root_m", metres(at.mean.root)},
                                 {"pose_m", metres(at.mean.pose)}});
  }
  return json;
}

void AddBodyJson(const BodyEvaluation& evaluation, Json* json) {
  static const std::set<std::string> kAtTop = {"true_pendulum", "recorded", "restoration_drawn"};
  for (const auto& [name, summary] : evaluation) {
    if (name == "restoration" || name == "generator") {
      Merge(ToJson(summary, true), json);
    } else if (kAtTop.count(name) == 1) {
      Merge(ToJson(summary, false), &(*json)[name]);
    } else {
      Merge(ToJson(summary, false), &(*json)["baselines"][name]);
    }
  }
}

Result<BodyMetrics> MeanBodyMetrics(const Json& json, const std::string& file) {
  try {
    BodyMetrics metrics{};
    for (int m = 0; m < kNumBodyMetrics; ++m)
      metrics[m] = json.at("mean").at(kBodyMetrics[m].Key());
    return metrics;
  } catch (const Json::exception& error) {
    return Error{
        "this is not a file of body scores from pushid-evaluate --restoration --json_out: " +
            std::string(error.what()),
        file};
  }
}

std::string TimedErrorsText(const BodyEvaluation& evaluation) {
  std::vector<std::string> header = {"m, after the last shown frame"};
  for (const char* what : {"root", "pose"}) {
    for (const int seconds : kErrorSeconds) {
      header.push_back(std::string(what) + " " + std::to_string(seconds) + " s");
    }
  }
  TextTable table = TextTable::OfNumbers(header);
  for (const auto& [name, summary] : evaluation) {
    std::vector<std::string> row = {Spaced(name)};
    for (double TimedError::*part : {&TimedError::root, &TimedError::pose}) {
      for (const TimedMean& at : summary.at) {
        row.push_back(at.recordings > 0 ? Cell(at.mean.*part) : "none");
      }
    }
    table.Add(row);
  }
  return table.ToString();
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
  text += table.ToString() + GroupsText(evaluation);
  if (!restores) return text;
  text += "\n";
  TextTable groups = NewTable("restoration by");
  const BodySummary& restored = found->second;
  const std::map by_key(restored.by.begin(), restored.by.end());
  for (const auto& [key, means] : by_key) {
    for (const auto& [name, mean] : means) groups.Add(Row(name, mean));
  }
  text += groups.ToString() + WithoutLabelText(restored.without_label);
  for (const BodyScore& score : restored.recordings) {
    if (!score.failure.empty()) text += score.id + ": " + score.failure + "\n";
  }
  return text;
}

}  // namespace pushid
