// ident: scores and their means.
#include "ident/prediction/evaluation.h"

#include <algorithm>
#include <cmath>

#include "ident/prediction/predicted_steps.h"
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

std::string MetricsText(const HipMetrics& metrics, int digits, int observed) {
  std::string text;
  for (const HipMetric& metric : MetricsOf(observed, false)) {
    text += (text.empty() ? "" : ", ") + metric.Text(metrics.*metric.value, digits);
  }
  return text;
}

ShownMetrics MetricsOf(int observed, bool bands) {
  ShownMetrics metrics(std::begin(kHipMetrics), std::end(kHipMetrics));
  if (observed > 0) metrics.push_back(kAfterMetric);
  if (bands) metrics.insert(metrics.end(), std::begin(kBandMetrics), std::end(kBandMetrics));
  return metrics;
}

RecordingScore ScoreHip(const PendulumRecording& recording, const HipPaths& predicted,
                        int observed) {
  RecordingScore score;
  score.id = recording.id;
  score.frames = recording.num_frames();
  const int people = recording.num_people();
  for (int n = 0; n < people; ++n) {
    double sum = 0.0, total = 0.0, final = 0.0;  // frames that were not seen do not count
    double after = 0.0, total_after = 0.0;
    for (int t = 1; t < score.frames; ++t) {
      const double weight = recording.Weight(n, t);
      const double error = (predicted[n][t] - recording.hip[n][t]).norm();
      sum += weight * error;
      total += weight;
      if (weight > 0.0) final = error;
      if (t < observed) continue;
      after += weight * error;
      total_after += weight;
    }
    score.hip_ade += total > 0.0 ? sum / total / people : 0.0;
    score.hip_fde += final / people;
    score.after_hip_ade += total_after > 0.0 ? after / total_after / people : 0.0;
  }
  score.propagation = ScorePropagation(recording, predicted);
  if (people > 1) score.predicted = predicted;
  return score;
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

MaybeError CheckObserved(const std::vector<PendulumRecording>& recordings, int observed) {
  if (observed < 1) {
    return Error{"--observed is " + std::to_string(observed) +
                 "; it must be at least 1: frame 0 is always seen"};
  }
  for (const PendulumRecording& recording : recordings) {
    if (observed < recording.num_frames()) continue;
    return Error{"recording " + recording.id + " has " + std::to_string(recording.num_frames()) +
                 " frames: --observed=" + std::to_string(observed) +
                 " leaves none to predict; it must be at most " +
                 std::to_string(recording.num_frames() - 1) +
                 ", or leave the recording out (--leave_out)"};
  }
  return std::nullopt;
}

namespace {

RecordingScore FailedScore(const PendulumRecording& recording, const std::string& failure) {
  RecordingScore score;
  score.id = recording.id;
  score.frames = recording.num_frames();
  score.fell = true;
  score.failure = failure;
  return score;
}

RecordingScore ScoreOf(const IdentifiedModel& model, const PendulumRecording& recording,
                       const Prediction& prediction, int observed) {
  if (!prediction.status.ok) return FailedScore(recording, OutsideText(prediction.status));
  RecordingScore score = ScoreHip(recording, prediction.hip, observed);
  AddContactFigures(model, recording, prediction, &score.propagation);
  score.fell = AnybodyFalls(prediction);
  score.steps = StepPredictions(recording, prediction);
  return score;
}

// Of frames that were seen by us but not by the predictor.
void AddInside(const PendulumRecording& recording, const HipDistribution& hips, int observed,
               RecordingScore* score) {
  const int person = recording.pushed_person;
  double inside[2] = {0.0, 0.0}, frames = 0.0;
  for (int t = observed; t < recording.num_frames(); ++t) {
    if (recording.Weight(person, t) == 0.0) continue;
    frames += 1.0;
    for (int axis : {0, 1}) {
      const double below = hips.Cdf(person, t - observed, axis, recording.hip[person][t][axis]);
      inside[axis] += 0.05 <= below && below <= 0.95 ? 1.0 : 0.0;
    }
  }
  if (frames == 0.0) return;
  score->inside90_x = inside[0] / frames;
  score->inside90_y = inside[1] / frames;
}

}  // namespace

RecordingScore ScoreModel(const IdentifiedModel& model, const PendulumRecording& recording,
                          int observed) {
  if (observed == 0) return ScoreOf(model, recording, Predict(model, recording), 0);
  Result<OnlinePredictor> made = OnlinePredictor::Make(model, recording, recording.num_frames());
  if (!made.ok()) return FailedScore(recording, made.error().message);
  OnlinePredictor& predictor = made.value();
  for (int t = 1; t < observed; ++t) predictor.Observe(FrameAt(recording, t));
  const Prediction prediction = predictor.Predict();
  RecordingScore score = ScoreOf(model, recording, prediction, observed);
  if (!score.failure.empty()) return score;
  score.effect = prediction.effect;
  AddInside(recording, predictor.Distribution(prediction), observed, &score);
  return score;
}

RecordingScore ScoreReanchored(const IdentifiedModel& model, const PendulumRecording& recording,
                               int observed) {
  const Prediction prediction = PredictReanchored(model, recording, observed);
  return ScoreOf(model, recording, prediction, observed);
}

namespace {

// How much harder and longer people are pushed and watched than they were.
constexpr double kStrongerPush = 1.4;
constexpr int kFramesPastTheEnd = 40;

}  // namespace

bool FallsWhenPushedHarder(const IdentifiedModel& model, const PendulumRecording& recording) {
  PendulumRecording harder = recording;
  harder.scene = ScalePushes(recording.scene, kStrongerPush);
  const Prediction prediction = Predict(model, harder, recording.num_frames() + kFramesPastTheEnd);
  return !prediction.status.ok || AnybodyFalls(prediction);
}

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

Evaluation Evaluate(const IdentifiedModel& model, const std::vector<PendulumRecording>& recordings,
                    int observed, const LabelKeys& group_by) {
  std::vector<RecordingScore> of_model, of_static, of_velocity, reanchored;
  for (const PendulumRecording& recording : recordings) {
    of_model.push_back(ScoreModel(model, recording, observed));
    of_static.push_back(ScoreHip(recording, StaticBaseline(recording, observed), observed));
    of_velocity.push_back(
        ScoreHip(recording, ConstantVelocityBaseline(recording, observed), observed));
    if (observed > 0) reanchored.push_back(ScoreReanchored(model, recording, observed));
  }
  const auto summary = [&](std::vector<RecordingScore>& scores, bool bands) {
    return Summarize(recordings, std::move(scores), observed, bands, group_by);
  };
  Evaluation evaluation{summary(of_model, observed > 0), summary(of_static, false),
                        summary(of_velocity, false)};
  if (observed > 0) evaluation.reanchored = summary(reanchored, false);
  return evaluation;
}

}  // namespace pushid
