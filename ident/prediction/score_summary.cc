// ident: means of scores, over recordings and groups of them.
#include <algorithm>

#include "ident/prediction/evaluation.h"
#include "ident/uncertainty/clusters.h"

namespace pushid {
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
    score.pushed = PersonKey(recordings[i], recordings[i].pushed_person);
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
