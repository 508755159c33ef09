// ident: scores of recordings; score_groups.cc has their means.
#include "ident/prediction/evaluation.h"

#include <algorithm>
#include <cmath>

#include "ident/prediction/predicted_steps.h"
#include "ident/uncertainty/clusters.h"

namespace pushid {

std::string MetricsText(const HipMetrics& metrics, int digits, int observed) {
  std::string text;
  for (const HipMetric& metric : TableMetrics(observed)) {
    text += (text.empty() ? "" : ", ") + metric.Text(metrics.*metric.value, digits);
  }
  return text;
}

ShownMetrics TableMetrics(int observed) {
  ShownMetrics metrics(std::begin(kHipMetrics), std::end(kHipMetrics));
  if (observed > 0) metrics.push_back(kAfterMetric);
  return metrics;
}

ShownMetrics MetricsOf(int observed, bool bands) {
  ShownMetrics metrics = TableMetrics(observed);
  if (observed > 0) {
    metrics.insert(metrics.end(), std::begin(kThirdMetrics), std::end(kThirdMetrics));
  }
  if (bands) metrics.insert(metrics.end(), std::begin(kBandMetrics), std::end(kBandMetrics));
  return metrics;
}

namespace {

// Mean errors over frames, weighted as the recording has them.
struct WeightedError {
  double sum = 0.0, weight = 0.0;
  void Add(double w, double error) { sum += w * error, weight += w; }
  double Mean() const { return weight > 0.0 ? sum / weight : 0.0; }
};

}  // namespace

RecordingScore ScoreHip(const PendulumRecording& recording, const HipPaths& predicted,
                        int observed) {
  RecordingScore score;
  score.id = recording.id;
  score.frames = recording.num_frames();
  const int people = recording.num_people();
  for (int n = 0; n < people; ++n) {
    WeightedError all, after, thirds[3];
    double final = 0.0;  // frames that were not seen do not count
    const int behind = std::max(1, observed);
    for (int t = 1; t < score.frames; ++t) {
      const double weight = recording.Weight(n, t);
      const double error = (predicted[n][t] - recording.hip[n][t]).norm();
      all.Add(weight, error);
      if (weight > 0.0) final = error;
      if (t < behind) continue;
      after.Add(weight, error);
      const int rest = score.frames - behind;
      for (int i = 0; i < 3; ++i) {  // a frame at least
        const int begin = i * rest / 3, end = std::max(begin + 1, (i + 1) * rest / 3);
        if (begin <= t - behind && t - behind < end) thirds[i].Add(weight, error);
      }
    }
    score.hip_ade += all.Mean() / people;
    score.hip_fde += final / people;
    score.after_hip_ade += after.Mean() / people;
    for (int i = 0; i < 3; ++i) score.*kThirdMetrics[i].value += thirds[i].Mean() / people;
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
    if (first->finished) timing.recorded_travel = first->travel;
  }
  const std::vector<FootStep> steps = PredictedSteps(prediction.path, person);
  if (steps.empty()) return timing;
  timing.lift_off = steps.front().lift_off * dt;
  if (steps.front().finished) timing.landing = steps.front().landing * dt;
  timing.travel = steps.front().travel;
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
                     recording.Stepped(person), recording.subject_ids[person]});
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
  double frames = 0.0;
  for (int t = observed; t < recording.num_frames(); ++t) {
    if (recording.Weight(person, t) == 0.0) continue;
    frames += 1.0;
    for (int axis : {0, 1}) {
      const double value = recording.hip[person][t][axis];
      const double off = std::abs(hips.Cdf(person, t - observed, axis, value) - 0.5);
      (axis == 0 ? score->inside90_x : score->inside90_y) += off <= 0.45 ? 1.0 : 0.0;
      (axis == 0 ? score->inside50_x : score->inside50_y) += off <= 0.25 ? 1.0 : 0.0;
      score->crps += 0.5 * hips.Crps(person, t - observed, axis, value);
    }
  }
  if (frames == 0.0) return;
  for (const HipMetric& metric : kBandMetrics) score->*metric.value /= frames;
}

}  // namespace

RecordingScore ScoreModel(const IdentifiedModel& model, const PendulumRecording& recording,
                          int observed, ForecastUse use) {
  if (observed == 0) return ScoreOf(model, recording, Predict(model, recording), 0);
  Result<OnlinePredictor> made =
      OnlinePredictor::Make(model, recording, recording.num_frames(), use);
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

const ScoreSummary& Evaluation::Baseline(const std::string& key) const {
  return std::find_if(baselines.begin(), baselines.end(),
                      [&key](const BaselineSummary& baseline) { return baseline.key == key; })
      ->summary;
}

Evaluation Evaluate(const IdentifiedModel& model, const std::vector<PendulumRecording>& recordings,
                    int observed, const LabelKeys& group_by, ForecastUse use) {
  const auto summary = [&](bool bands, const auto& score) {
    std::vector<RecordingScore> scores;
    for (const PendulumRecording& recording : recordings) scores.push_back(score(recording));
    return Summarize(recordings, std::move(scores), observed, bands, group_by);
  };
  Evaluation evaluation;
  evaluation.model = summary(observed > 0, [&](const PendulumRecording& recording) {
    return ScoreModel(model, recording, observed, use);
  });
  for (const pushid::Baseline& baseline : kBaselines) {
    if (baseline.needs_frames && observed == 0) continue;
    evaluation.baselines.push_back(
        {baseline.name, baseline.key, summary(false, [&](const PendulumRecording& recording) {
           return ScoreHip(recording, baseline.predict(recording, observed), observed);
         })});
  }
  if (observed > 0) {
    evaluation.baselines.push_back(
        {"re-anchored", "reanchored", summary(false, [&](const PendulumRecording& recording) {
           return ScoreReanchored(model, recording, observed);
         })});
  }
  return evaluation;
}

}  // namespace pushid
