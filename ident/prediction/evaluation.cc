// ident: scores and their means.
#include "ident/prediction/evaluation.h"

#include <algorithm>
#include <cmath>

#include "ident/prediction/predicted_steps.h"
#include "ident/uncertainty/clusters.h"
#include "residuals/cost_functions/rest_residual.h"

namespace pushid {
namespace {

MeanScore Mean(const std::vector<const RecordingScore*>& scores, bool by_frames) {
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
  for (const HipMetric& metric : kHipMetrics) {
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

std::string MetricsText(const HipMetrics& metrics, int digits) {
  std::string text;
  for (const HipMetric& metric : kHipMetrics) {
    text += (text.empty() ? "" : ", ") + metric.Text(metrics.*metric.value, digits);
  }
  return text;
}

RecordingScore ScoreHip(const PendulumRecording& recording, const HipPaths& predicted) {
  RecordingScore score;
  score.id = recording.id;
  score.frames = recording.num_frames();
  const int people = recording.num_people();
  for (int n = 0; n < people; ++n) {
    double sum = 0.0, total = 0.0, final = 0.0;  // frames that were not seen do not count
    for (int t = 1; t < score.frames; ++t) {
      const double weight = recording.Weight(n, t);
      const double error = (predicted[n][t] - recording.hip[n][t]).norm();
      sum += weight * error;
      total += weight;
      if (weight > 0.0) final = error;
    }
    score.hip_ade += total > 0.0 ? sum / total / people : 0.0;
    score.hip_fde += final / people;
  }
  score.propagation = ScorePropagation(recording, predicted);
  return score;
}

HipPaths StaticBaseline(const PendulumRecording& recording) {
  HipPaths paths;
  for (const auto& hip : recording.hip) paths.emplace_back(hip.size(), hip[0]);
  return paths;
}

HipPaths ConstantVelocityBaseline(const PendulumRecording& recording) {
  HipPaths paths;
  const int last = std::min(recording.scene.LastPushEnd(), recording.num_frames() - 1);
  for (const auto& hip : recording.hip) {
    std::vector<Vector3<double>> path(hip.begin(), hip.begin() + last + 1);
    const Vector3<double> step =
        last > 0 ? Vector3<double>(hip[last] - hip[last - 1]) : Vector3<double>::Zero();
    while (path.size() < hip.size()) path.push_back(path.back() + step);
    paths.push_back(std::move(path));
  }
  return paths;
}

namespace {

StepTiming TimingOf(const PendulumRecording& recording, const Prediction& prediction, int person) {
  const double dt = recording.scene.dt;
  StepTiming timing;
  if (const FootStep* first = recording.steps[person].First()) {
    timing.recorded_lift_off = first->lift_off * dt;
  }
  const std::vector<SteppingPhase> phases = SteppingPhases(prediction.path, person);
  if (phases.empty()) return timing;
  timing.lift_off = phases.front().lift_off * dt;
  if (phases.front().finished) timing.landing = phases.front().landing * dt;
  timing.travel = phases.front().travel;
  return timing;
}

bool AnybodyFalls(const Prediction& prediction) {
  for (int t = 0; t < prediction.path.num_frames(); ++t) {
    for (int n = 0; n < prediction.path.num_people(); ++n) {
      if (prediction.path.At(t, n).q.tail<2>().cwiseAbs().maxCoeff() > kFallAngle) return true;
    }
  }
  return false;
}

}  // namespace

std::vector<StepPrediction> StepPredictions(const PendulumRecording& recording,
                                            const Prediction& prediction) {
  std::vector<StepPrediction> steps;
  if (!recording.StepsKnown()) return steps;
  for (size_t n = 0; n < prediction.steps.size(); ++n) {
    const int person = static_cast<int>(n);
    steps.push_back({prediction.steps[n].margin, prediction.steps[n].probability,
                     recording.Stepped(person), PersonKey(recording, person)});
    if (prediction.feet_step) steps.back().timing = TimingOf(recording, prediction, person);
  }
  return steps;
}

RecordingScore ScoreModel(const IdentifiedModel& model, const PendulumRecording& recording) {
  const Prediction prediction = Predict(model, recording);
  if (!prediction.status.ok) {
    RecordingScore score;
    score.id = recording.id;
    score.frames = recording.num_frames();
    score.fell = true;
    score.failure = std::string(prediction.status.quantity) + " of person " +
                    std::to_string(prediction.status.person) +
                    " leaves the model's domain at frame " +
                    std::to_string(prediction.status.frame);
    return score;
  }
  RecordingScore score = ScoreHip(recording, prediction.hip);
  AddContactFigures(model, recording, prediction, &score.propagation);
  score.fell = AnybodyFalls(prediction);
  score.steps = StepPredictions(recording, prediction);
  return score;
}

bool FallsWhenPushedHarder(const IdentifiedModel& model, const PendulumRecording& recording) {
  PendulumRecording harder = recording;
  harder.scene = ScalePushes(recording.scene, kStrongerPush);
  const Prediction prediction = Predict(model, harder, recording.num_frames() + kFramesPastTheEnd);
  return !prediction.status.ok || AnybodyFalls(prediction);
}

ScoreSummary Summarize(const std::vector<PendulumRecording>& recordings,
                       std::vector<RecordingScore> scores) {
  ScoreSummary summary;
  summary.recordings = std::move(scores);
  using Group = std::vector<const RecordingScore*>;
  Group all;
  std::map<std::string, Group> magnitude, subject, setting;
  for (size_t i = 0; i < recordings.size(); ++i) {
    RecordingScore& score = summary.recordings[i];
    const PendulumRecording& recording = recordings[i];
    score.pushed = PersonKey(recording, recording.pushed_person);
    if (!score.failure.empty()) continue;
    all.push_back(&score);
    magnitude[recording.magnitude].push_back(&score);
    subject[recording.subject_ids[recording.pushed_person]].push_back(&score);
    setting[recording.setting].push_back(&score);
  }
  auto propagation = [](const Group& group) {
    std::vector<const PropagationScore*> of_group;
    for (const RecordingScore* score : group) of_group.push_back(&score->propagation);
    return SummarizePropagation(of_group);
  };
  summary.propagation = propagation(all);
  std::vector<StepPrediction> steps;
  for (const RecordingScore* score : all) {
    steps.insert(steps.end(), score->steps.begin(), score->steps.end());
  }
  summary.steps = ScoreSteps(steps);
  for (const auto& [key, group] : setting) {
    const PropagationSummary of_setting = propagation(group);
    if (of_setting.recordings > 0) summary.propagation_by_setting[key] = of_setting;
  }
  summary.mean = Mean(all, false);
  summary.frame_weighted = Mean(all, true);
  for (const auto& [key, group] : magnitude) summary.by_magnitude[key] = Mean(group, false);
  for (const auto& [key, group] : subject) summary.by_subject[key] = Mean(group, false);
  for (const auto& [key, group] : setting) summary.by_setting[key] = Mean(group, false);
  return summary;
}

Evaluation Evaluate(const IdentifiedModel& model,
                    const std::vector<PendulumRecording>& recordings) {
  std::vector<RecordingScore> of_model, of_static, of_velocity;
  for (const PendulumRecording& recording : recordings) {
    of_model.push_back(ScoreModel(model, recording));
    of_static.push_back(ScoreHip(recording, StaticBaseline(recording)));
    of_velocity.push_back(ScoreHip(recording, ConstantVelocityBaseline(recording)));
  }
  return {Summarize(recordings, std::move(of_model)), Summarize(recordings, std::move(of_static)),
          Summarize(recordings, std::move(of_velocity))};
}

}  // namespace pushid
