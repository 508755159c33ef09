// ident: scores of bodies and their means, of restorations and of baselines.
#include "ident/bodies/body_evaluation.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <set>

#include "ident/model/model_rollout.h"
#include "ident/prediction/online_predictor.h"
#include "ident/validation/scores_report.h"
#include "models/learned_terms.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;

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

std::vector<std::string> Row(const std::string& name, const MeanScore& mean) {
  std::vector<std::string> row = {name, std::to_string(mean.recordings)};
  for (MetricId m : kBodyMetrics) {
    row.push_back(Cell(mean.value[m], kMetrics[m].with_error ? mean.error[m] : 0.0));
  }
  return row;
}

TextTable NewTable(const std::string& first) {
  std::vector<std::string> header = {first, "recordings"};
  for (MetricId m : kBodyMetrics) header.push_back(kMetrics[m].Title());
  return TextTable::OfNumbers(header);
}

std::string Spaced(std::string name) {
  for (char& c : name) c = c == '_' ? ' ' : c;
  return name;
}

// Metrics of groups, where there are any.
std::string GroupsText(const BodyEvaluation& evaluation) {
  NamedValues<GroupMetrics> rows;
  for (const auto& [name, summary] : evaluation) {
    if (summary.groups) rows.emplace_back(Spaced(name), &*summary.groups);
  }
  return rows.empty() ? "" : "\n" + GroupMetricsText(rows);
}

constexpr double kTouchHeight = 0.025;  // m
constexpr double kCentimetres = 100.0;  // per m

// The metrics of one person, but the FSE, over frames first_frame .. end - 1.
Metrics ScorePerson(const BodyMotion& recorded, const BodyMotion& predicted, int first_frame,
                    int end) {
  Metrics sum = Metrics::Zero();
  for (int t = first_frame; t < end; ++t) {
    const Pose error = predicted[t] - recorded[t];
    const Eigen::Vector3d hip = error.col(0);
    sum[kMpjpe] += error.colwise().norm().mean();
    sum[kHipAde] += hip.norm();
    sum[kMble] +=
        (BoneLengths(predicted[t]) - BoneLengths(recorded[t])).cwiseAbs().sum() / (kBodyJoints - 1);
    sum[kRelativeMpjpe] += (error.colwise() - hip).colwise().norm().mean();
  }
  sum /= end - first_frame;
  sum[kHipFde] = (predicted[end - 1] - recorded[end - 1]).col(0).norm();
  return sum;
}

// Mean over the recordings that last so long.
MeanScore MeanAt(const std::vector<BodyScore>& scores, size_t second) {
  MeanScore mean;
  for (const BodyScore& score : scores) {
    if (!score.failure.empty() || !score.at[second]) continue;
    ++mean.recordings;
    mean.value += *score.at[second];
  }
  mean.value /= std::max(1, mean.recordings);
  return mean;
}

std::optional<GroupMetrics> GroupsOf(const std::vector<BodyRecording>& recordings,
                                     const std::vector<BodyScore>& scores) {
  std::vector<GroupMotion> recorded, predicted;
  for (size_t i = 0; i < recordings.size(); ++i) {
    if (scores[i].predicted.empty()) continue;
    const PendulumRecording& pendulum = recordings[i].pendulum;
    const int first = scores[i].first_frame;
    recorded.push_back({recordings[i].bodies, pendulum.scene.dt, pendulum.pushed_person, first});
    predicted.push_back({scores[i].predicted, pendulum.scene.dt, pendulum.pushed_person, first});
  }
  if (recorded.empty()) return std::nullopt;
  return CompareGroups(recorded, predicted);
}

}  // namespace

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
    BodyScore failed;
    failed.id = recording.pendulum.id;
    failed.frames = recording.num_frames();
    failed.failure =
        predicted.ok() ? OutsideText(predicted.value().status) : predicted.error().message;
    for (const char* name : {"restoration", "rigid"}) (*scores)[name].push_back(failed);
    if (observed > 0) (*scores)["restoration_all_frames"].push_back(failed);
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

void ScoreForecast(const BodyRecording& recording, const std::vector<BodyMotion>& forecast,
                   int observed, BodyScores* scores) {
  const auto add = [&](const char* name, const std::vector<BodyMotion>& bodies, int first_frame) {
    (*scores)[name].push_back(ScoreBodies(recording, bodies, first_frame));
  };
  const int seen = observed > 1 ? observed : 0;  // one is the first pose, which everybody knows
  add("generator", forecast, observed);
  if (observed > 1) add("generator_all_frames", forecast, 1);
  add("static", StaticBodies(recording, seen), observed);
  add("constant_velocity", ConstantVelocityBodies(recording, seen), observed);
}

BodyEvaluation SummarizeAll(const std::vector<BodyRecording>& recordings, const BodyScores& scores,
                            const LabelKeys& group_by) {
  BodyEvaluation evaluation;
  for (const auto& [name, of_name] : scores) {
    evaluation[name] = SummarizeBodies(recordings, of_name, group_by);
  }
  return evaluation;
}

Json ToJson(const BodySummary& summary, bool with_recordings) {
  Json json;
  if (with_recordings) {
    json["recordings"] = Json::array();
    for (const BodyScore& score : summary.recordings) {
      json["recordings"].push_back(ScoreJson(score, kBodyMetrics));
    }
  }
  AddMeans(summary, kBodyMetrics, false, &json);
  if (summary.groups) json["group_metrics"] = ToJson(*summary.groups);
  json["errors_at"] = Json::array();
  for (size_t i = 0; i < summary.at.size(); ++i) {
    const MeanScore& at = summary.at[i];
    Json row = {{"seconds", kErrorSeconds[i]}, {"recordings", at.recordings}};
    for (const auto& [name, metric] : kTimedErrors) {
      row[std::string(name) + "_m"] = at.recordings > 0 ? Json(at.value[metric]) : Json();
    }
    json["errors_at"].push_back(row);
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

std::string TimedErrorsText(const BodyEvaluation& evaluation) {
  std::vector<std::string> header = {"m, mean from the last shown frame"};
  for (const auto& [what, metric] : kTimedErrors) {
    for (const int seconds : kErrorSeconds) {
      header.push_back(std::string(what) + " to " + std::to_string(seconds) + " s");
    }
  }
  TextTable table = TextTable::OfNumbers(header);
  for (const auto& [name, summary] : evaluation) {
    std::vector<std::string> row = {Spaced(name)};
    for (const auto& [what, metric] : kTimedErrors) {
      for (const MeanScore& at : summary.at) {
        row.push_back(at.recordings > 0 ? Cell(at.value[metric]) : "none");
      }
    }
    table.Add(row);
  }
  return table.ToString();
}

TextTable BodyTable(const BodyEvaluation& evaluation) {
  TextTable table = NewTable("bodies, means over recordings");
  const auto found = evaluation.find("restoration");
  if (found != evaluation.end()) table.Add(Row("restoration", found->second.mean));
  for (const auto& [name, summary] : evaluation) {
    if (name != "restoration") table.Add(Row(Spaced(name), summary.mean));
  }
  return table;
}

std::string BodyText(const BodyEvaluation& evaluation) {
  const std::string text = BodyTable(evaluation).ToString() + GroupsText(evaluation);
  const auto found = evaluation.find("restoration");
  if (found == evaluation.end()) return text;
  TextTable groups = NewTable("restoration by");
  const BodySummary& restored = found->second;
  const std::map by_key(restored.by.begin(), restored.by.end());
  for (const auto& [key, means] : by_key) {
    for (const auto& [name, mean] : means) groups.Add(Row(name, mean));
  }
  std::string failures;
  for (const BodyScore& score : restored.recordings) {
    if (!score.failure.empty()) failures += score.id + ": " + score.failure + "\n";
  }
  return text + "\n" + groups.ToString() +
         TextLines(WithoutLabelText(restored.without_label) + failures);
}

double FootSkate(const BodyMotion& motion, int first_frame) {
  double sum = 0.0;
  int contacts = 0;
  for (const int ankle : {kRightAnkle, kLeftAnkle}) {
    for (size_t t = first_frame; t < motion.size(); ++t) {
      const double height = motion[t](2, ankle) - motion[0](2, ankle);
      if (height >= kTouchHeight) continue;
      const double way = (motion[t] - motion[t - 1]).col(ankle).head<2>().norm();
      sum += way * (2.0 - std::exp2(std::max(0.0, height) / kTouchHeight));
      ++contacts;
    }
  }
  return contacts > 0 ? kCentimetres * sum / contacts : -1.0;
}

BodyScore ScoreBodies(const BodyRecording& recording, const std::vector<BodyMotion>& predicted,
                      int first_frame) {
  BodyScore score;
  score.id = recording.pendulum.id;
  score.frames = recording.num_frames();
  score.first_frame = first_frame;
  const int people = recording.num_people();
  const auto up_to = [&](int end) {
    Metrics mean = Metrics::Zero();
    for (int n = 0; n < people; ++n) {
      mean += ScorePerson(recording.bodies[n], predicted[n], first_frame, end) / people;
    }
    return mean;
  };
  score.value = up_to(score.frames);
  int touching = 0;
  for (const BodyMotion& motion : predicted) {
    const double skate = FootSkate(motion, first_frame);
    if (skate < 0.0) continue;
    score.value[kFse] += skate;
    ++touching;
  }
  score.value[kFse] /= std::max(1, touching);
  for (size_t i = 0; i < kErrorSeconds.size(); ++i) {
    const double after = kErrorSeconds[i] / recording.pendulum.scene.dt;
    const int end = first_frame + static_cast<int>(std::lround(after));
    if (end <= score.frames) score.at[i] = up_to(end);
  }
  if (people > 1) score.predicted = predicted;
  return score;
}

BodySummary SummarizeBodies(const std::vector<BodyRecording>& recordings,
                            std::vector<BodyScore> scores, const LabelKeys& group_by) {
  ScoreList all;
  std::vector<PendulumRecording> pendulums;
  for (size_t i = 0; i < recordings.size(); ++i) {
    pendulums.push_back(recordings[i].pendulum);
    all.push_back(&scores[i]);
  }
  BodySummary summary;
  static_cast<ScoreMeans&>(summary) = MeansOf(pendulums, all, group_by);
  summary.groups = GroupsOf(recordings, scores);
  for (size_t i = 0; i < summary.at.size(); ++i) summary.at[i] = MeanAt(scores, i);
  summary.recordings = std::move(scores);
  return summary;
}

}  // namespace pushid
