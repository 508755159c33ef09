// ident: groups and clusters of scores.

#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <sstream>

#include "datasets/files/number_text.h"
#include "ident/prediction/evaluation.h"
#include "ident/uncertainty/clusters.h"

namespace pushid {

double ScoreClusters::ErrorOfMean(const std::vector<double>& deviations) const {
  if (count < 2) return 0.0;
  std::vector<double> sums(count, 0.0);
  for (size_t i = 0; i < deviations.size(); ++i) sums[of[i]] += deviations[i];
  double squares = 0.0;
  for (double sum : sums) squares += sum * sum;
  return std::sqrt(squares * count / (count - 1.0));
}

MeanAndError ScoreClusters::Mean(const std::vector<double>& values) const {
  const double mean = MeanOf(values).mean, n = static_cast<double>(values.size());
  std::vector<double> deviations;
  for (double value : values) deviations.push_back((value - mean) / n);
  return {mean, ErrorOfMean(deviations)};
}

ScoreClusters ClustersOf(const std::vector<std::string>& pushed) {
  ScoreClusters clusters;
  std::map<std::string, int> people;
  for (const std::string& person : pushed) {
    clusters.of.push_back(people.emplace(person, static_cast<int>(people.size())).first->second);
  }
  clusters.count = static_cast<int>(people.size());
  if (clusters.count > 1 && people.size() < pushed.size()) {
    clusters.by = ClusterBy::kSubject;
    return clusters;
  }
  clusters.count = static_cast<int>(pushed.size());
  std::iota(clusters.of.begin(), clusters.of.end(), 0);
  return clusters;
}

ScoreClusters ClustersOf(const std::vector<PendulumRecording>& recordings) {
  std::vector<std::string> pushed;
  for (const PendulumRecording& r : recordings) pushed.push_back(r.subject_ids[r.pushed_person]);
  return ClustersOf(pushed);
}

std::string ClustersText(ClusterBy by, int count) {
  const bool people = by == ClusterBy::kSubject;
  const char* const what =
      people ? (count == 1 ? " person" : " people") : (count == 1 ? " recording" : " recordings");
  return std::to_string(count) + what;
}

LabelKeys UsualGroups() { return {kMagnitudeLabel, kSubjectUnit, kSettingLabel}; }

LabelKeys ParseLabelKeys(const std::string& list) {
  LabelKeys keys;
  std::stringstream words(list);
  for (std::string key; std::getline(words, key, ',');) keys.emplace_back(Trimmed(key));
  return keys;
}

std::string LabelKeysText(const LabelKeys& keys) {
  std::string text;
  for (const std::string& key : keys) text += (text.empty() ? "" : ",") + key;
  return text;
}

MaybeError CheckGroups(const std::vector<PendulumRecording>& recordings, const LabelKeys& keys) {
  if (keys == UsualGroups()) return std::nullopt;  // any of these may be absent
  std::set<std::string> seen;
  for (const std::string& key : keys) {
    const std::string list = "--group_by=" + LabelKeysText(keys);
    if (key.empty()) return Error{list + " has an empty name; give labels with one comma between"};
    if (!seen.insert(key).second) return Error{list + " names '" + key + "' twice"};
    if (MaybeError error = CheckLabel(recordings, "group_by", key, kSubjectUnit)) return error;
  }
  return std::nullopt;
}

std::string WithoutLabelText(const WithoutLabel& counts) {
  std::string text;
  for (const auto& [key, count] : counts) {
    text += std::to_string(count) + " recording" + (count == 1 ? " has" : "s have") + " no " + key +
            ": " + (count == 1 ? "it is" : "they are") + " in no group by " + key + "\n";
  }
  return text;
}

std::vector<std::string> GroupNames(const std::vector<PendulumRecording>& recordings,
                                    const std::string& key) {
  std::vector<std::string> names;
  for (const PendulumRecording& r : recordings) {
    names.push_back(key == kSubjectUnit ? r.subject_ids[r.pushed_person] : r.labels.Of(key));
  }
  return names;
}

namespace {

using Group = std::vector<const RecordingScore*>;

MeanScore Mean(const Group& scores, bool by_frames) {
  MeanScore mean;
  const auto weight = [by_frames](const RecordingScore* s) {
    return by_frames ? s->frames - 1 : 1.0;
  };
  double total = 0.0;
  for (const RecordingScore* s : scores) total += weight(s);
  mean.recordings = static_cast<int>(scores.size());
  if (scores.empty()) return mean;
  std::vector<std::string> pushed;
  for (const RecordingScore* s : scores) pushed.push_back(s->pushed);
  const ScoreClusters clusters = ClustersOf(pushed);
  mean.clustered_by = clusters.by;
  mean.clusters = clusters.count;
  for (const HipMetric& metric : AllHipMetrics()) {
    const auto value = metric.value;
    for (const RecordingScore* s : scores) mean.*value += weight(s) * s->*value;
    mean.*value /= total;
    std::vector<double> deviations;
    for (const RecordingScore* s : scores) {
      deviations.push_back(weight(s) / total * (s->*value - mean.*value));
    }
    mean.error.*value = clusters.ErrorOfMean(deviations);
  }
  return mean;
}

}  // namespace

ScoreSummary Summarize(const std::vector<PendulumRecording>& recordings,
                       std::vector<RecordingScore> scores, int observed, bool bands,
                       const LabelKeys& group_by) {
  ScoreSummary summary;
  summary.observed = observed;
  summary.bands = bands;
  summary.recordings = std::move(scores);
  Group all;
  std::vector<StepPrediction> steps;
  for (size_t i = 0; i < recordings.size(); ++i) {
    RecordingScore& score = summary.recordings[i];
    score.pushed = recordings[i].subject_ids[recordings[i].pushed_person];
    if (!score.failure.empty()) continue;
    all.push_back(&score);
    steps.insert(steps.end(), score.steps.begin(), score.steps.end());
  }
  summary.steps = ScoreSteps(steps);
  const auto propagation = [](const Group& group) {
    std::vector<const PropagationScore*> of_group;
    for (const RecordingScore* score : group) of_group.push_back(&score->propagation);
    return SummarizePropagation(of_group);
  };
  summary.propagation = propagation(all);
  const auto by_setting = GroupScores(recordings, summary.recordings, {kSettingLabel}, propagation);
  for (const auto& [name, of_setting] : by_setting.at(kSettingLabel)) {
    if (of_setting.recordings > 0) summary.propagation_by_setting[name] = of_setting;
  }
  summary.mean = Mean(all, false);
  summary.frame_weighted = Mean(all, true);
  summary.by = GroupScores(recordings, summary.recordings, group_by,
                           [](const Group& group) { return Mean(group, false); });
  LabelKeys keys = group_by;
  if (!summary.propagation_by_setting.empty()) keys.push_back(kSettingLabel);
  summary.without_label = CountWithoutLabel(recordings, summary.recordings, keys);
  return summary;
}

}  // namespace pushid
