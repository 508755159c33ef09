#include "ident/prediction/evaluation.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "ident/uncertainty/covariance.h"
#include "models/decompositions.h"

namespace pushid {
namespace {

struct Motion {
  Vector3<double> place, velocity = Vector3<double>::Zero(), acceleration = velocity;
};

constexpr int kLeastPredicted = 10;                                   // frames
constexpr double kWindow = 14.0 / 60.0, kFading = 0.25, kDrag = 1.0;  // s, s and 1/s

// Hips as recorded until the last known frame, then extrapolated from the last frame in which the
// person was seen. motion_at(hip, seen, frame) is the motion at that frame, seen(t) whether the hip
// was seen at frame t (frame 0 always was); step advances the motion by one frame.
template <typename MotionAt, typename Step>
HipPaths GoneOn(const PendulumRecording& recording, int observed, const MotionAt& motion_at,
                const Step& step) {
  // A push may last as long as its recording: something must be left to predict.
  const int frames = recording.num_frames();
  const int latest = std::max(frames / 2, frames - 1 - kLeastPredicted);
  const int known = std::min(
      frames - 1, observed > 0 ? observed - 1 : std::min(recording.scene.LastPushEnd(), latest));
  HipPaths paths;
  for (int n = 0; n < recording.num_people(); ++n) {
    const HipPath& hip = recording.hip[n];
    const auto seen = [&](int t) { return t == 0 || recording.Weight(n, t) > 0.0; };
    int last = known;
    while (!seen(last)) --last;
    Motion motion = motion_at(hip, seen, last);
    HipPath& path = paths.emplace_back(hip.begin(), hip.begin() + known + 1);
    for (int t = last + 1; t < frames; ++t) {
      step(&motion);
      if (t > known) path.push_back(motion.place);
    }
  }
  return paths;
}

// Mean errors over frames, weighted as the recording has them.
struct WeightedError {
  double sum = 0.0, weight = 0.0;
  void Add(double w, double error) { sum += w * error, weight += w; }
  double Mean() const { return weight > 0.0 ? sum / weight : 0.0; }
};

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

RecordingScore FailedScore(const PendulumRecording& recording, const std::string& failure,
                           int observed) {
  RecordingScore score;
  score.id = recording.id;
  score.frames = recording.num_frames();
  score.fell = true;
  score.failure = failure;
  score.value =
      ScoreHip(recording, StaticBaseline(recording), observed).value;  // for MeanWithStatic
  return score;
}

RecordingScore ScoreOf(const IdentifiedModel& model, const PendulumRecording& recording,
                       const Prediction& prediction, int observed) {
  if (!prediction.status.ok)
    return FailedScore(recording, OutsideText(prediction.status), observed);
  RecordingScore score = ScoreHip(recording, prediction.hip, observed);
  AddContactFigures(model, prediction, &score.propagation);
  score.fell = AnybodyFalls(prediction);
  score.steps = StepPredictions(recording, prediction);
  return score;
}

// inside: whether a value at a frame, of the hip's x or y, lies in the central share.
template <typename Inside, typename CrpsOf>
void AddBands(const PendulumRecording& recording, int from, const Inside& inside,
              const CrpsOf& crps, RecordingScore* score) {
  const int person = recording.pushed_person;
  double frames = 0.0;
  for (int t = from; t < recording.num_frames(); ++t) {
    if (recording.Weight(person, t) == 0.0) continue;
    frames += 1.0;
    for (int axis : {0, 1}) {
      const double value = recording.hip[person][t][axis];
      score->value[kInside90 + axis] += inside(t, axis, value, 0.9);
      score->value[kInside50 + axis] += inside(t, axis, value, 0.5);
      score->value[kCrps] += 0.5 * crps(t, axis, value);
    }
  }
  if (frames > 0.0) score->value.segment<kCrps + 1 - kInside90>(kInside90) /= frames;
}

ScoreList Scored(const ScoreList& scores) {
  ScoreList scored;
  std::copy_if(scores.begin(), scores.end(), std::back_inserter(scored),
               [](const Score* score) { return score->failure.empty(); });
  return scored;
}

}  // namespace

HipPaths StaticBaseline(const PendulumRecording& recording, int observed) {
  HipPaths paths;
  for (const auto& hip : recording.hip) {
    HipPath path(hip.begin(), hip.begin() + std::max(1, observed));
    path.resize(hip.size(), Vector3<double>(path.back()));
    paths.push_back(std::move(path));
  }
  return paths;
}

HipPaths ConstantVelocityBaseline(const PendulumRecording& recording, int observed) {
  const double dt = recording.scene.dt;
  const auto since_before = [dt](const HipPath& hip, const auto& seen, int last) {
    Motion motion{hip[last]};
    int before = std::max(0, last - 1);
    while (!seen(before)) --before;
    if (last > before) motion.velocity = (hip[last] - hip[before]) / ((last - before) * dt);
    return motion;
  };
  return GoneOn(recording, observed, since_before,
                [dt](Motion* m) { m->place += dt * m->velocity; });
}

HipPaths KinematicBaseline(const PendulumRecording& recording, int observed) {
  const double dt = recording.scene.dt;
  const auto quadratic = [dt](const HipPath& hip, const auto& seen, int last) {
    const int window = std::max(3, static_cast<int>(std::lround(kWindow / dt)));
    std::vector<int> frames;
    for (int t = std::max(0, last - window + 1); t <= last; ++t) {
      if (seen(t)) frames.push_back(t);
    }
    Motion motion{hip[last]};
    const int order = std::min<int>(3, static_cast<int>(frames.size()));
    if (order < 2) return motion;
    Eigen::MatrixXd powers(frames.size(), order), places(frames.size(), 3);
    for (size_t i = 0; i < frames.size(); ++i) {
      const double s = (frames[i] - last) * dt;
      for (int j = 0; j < order; ++j) powers(i, j) = j == 0 ? 1.0 : j == 1 ? s : 0.5 * s * s;
      places.row(i) = hip[frames[i]].transpose();
    }
    const Eigen::MatrixXd fitted = SolveSymmetric(Eigen::MatrixXd(powers.transpose() * powers),
                                                  Eigen::MatrixXd(powers.transpose() * places));
    motion.velocity = fitted.row(1).transpose();
    if (order > 2) motion.acceleration = fitted.row(2).transpose();
    return motion;
  };
  return GoneOn(recording, observed, quadratic, [dt](Motion* m) {
    m->velocity += dt * (m->acceleration - kDrag * m->velocity);
    m->acceleration *= std::exp(-dt / kFading);
    m->place += dt * m->velocity;
  });
}

std::vector<Baseline> Baselines(int observed) {
  std::vector<Baseline> baselines = {
      {"static", "static", StaticBaseline},
      {"constant velocity", "constant_velocity", ConstantVelocityBaseline}};
  if (observed > 0) baselines.push_back({"kinematic", "kinematic", KinematicBaseline});
  return baselines;
}

std::string Metric::Title() const {
  std::string title = std::string(name) + " " + unit;
  std::replace(title.begin(), title.end(), '_', ' ');
  return title;
}

std::string Metric::Text(double value, int digits) const {
  std::string text = Title();
  return text.insert(text.rfind(' '), " " + Rounded(value, digits));
}

std::string MetricsText(const MetricList& metrics, const Metrics& values, int digits) {
  std::string text;
  for (MetricId m : metrics) {
    text += (text.empty() ? "" : ", ") + kMetrics[m].Text(values[m], digits);
  }
  return text;
}

MetricList TableMetrics(int observed) {
  return observed > 0 ? MetricList{kHipAde, kHipFde, kAfterHipAde} : MetricList{kHipAde, kHipFde};
}

MetricList MetricsOf(int observed, bool bands) {
  MetricList metrics;
  for (int m = kHipAde; m < kMpjpe; ++m) {
    const bool wanted = m >= kInside90 ? bands : m >= kAfterHipAde ? observed > 0 : true;
    if (wanted) metrics.push_back(static_cast<MetricId>(m));
  }
  return metrics;
}

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
    score.value[kHipAde] += all.Mean() / people;
    score.value[kHipFde] += final / people;
    score.value[kAfterHipAde] += after.Mean() / people;
    for (int i = 0; i < 3; ++i) score.value[kFirstThird + i] += thirds[i].Mean() / people;
  }
  score.propagation = ScorePropagation(recording, predicted);
  return score;
}

bool AnybodyFalls(const Prediction& prediction) {
  for (int t = 0; t < prediction.path.num_frames(); ++t) {
    for (int n = 0; n < prediction.path.num_people(); ++n) {
      if (prediction.path.At(t, n).q.tail<2>().cwiseAbs().maxCoeff() > kFallAngle) return true;
    }
  }
  return false;
}

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

void ScoreDraws(const PendulumRecording& recording, const DrawnPaths& draws,
                RecordingScore* score) {
  const auto values = [&](int t, int axis) {
    return ValuesAt(draws, recording.pushed_person, static_cast<size_t>(t), axis);
  };
  AddBands(
      recording, 1,
      [&](int t, int axis, double value, double share) {
        return Within(values(t, axis), value, share) ? 1.0 : 0.0;
      },
      [&](int t, int axis, double value) { return Crps(values(t, axis), value); }, score);
}

RecordingScore ScoreModel(const IdentifiedModel& model, const PendulumRecording& recording,
                          int observed, ForecastUse use) {
  if (observed == 0) return ScoreOf(model, recording, Predict(model, recording), 0);
  Result<OnlinePredictor> made =
      OnlinePredictor::Make(model, recording, recording.num_frames(), use);
  if (!made.ok()) return FailedScore(recording, made.error().message, observed);
  OnlinePredictor& predictor = made.value();
  for (int t = 1; t < observed; ++t) predictor.Observe(FrameAt(recording, t));
  const Prediction prediction = predictor.Predict();
  RecordingScore score = ScoreOf(model, recording, prediction, observed);
  if (!score.failure.empty()) return score;
  const HipDistribution hips = predictor.Distribution(prediction);
  const int person = recording.pushed_person;
  AddBands(
      recording, observed,
      [&](int t, int axis, double value, double share) {
        const double off = std::abs(hips.Cdf(person, t - observed, axis, value) - 0.5);
        return off <= 0.5 * share ? 1.0 : 0.0;
      },
      [&](int t, int axis, double value) { return hips.Crps(person, t - observed, axis, value); },
      &score);
  return score;
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
  for (const pushid::Baseline& baseline : Baselines(observed)) {
    evaluation.baselines.push_back(
        {baseline.name, baseline.key, summary(false, [&](const PendulumRecording& recording) {
           return ScoreHip(recording, baseline.predict(recording, observed), observed);
         })});
  }
  return evaluation;
}

std::string ClustersText(ClusterBy by, int count) {
  return by == ClusterBy::kSubject ? CountText(count, "person", "people")
                                   : CountText(count, "recording");
}

LabelKeys UsualGroups() { return {kMagnitudeLabel, kSubjectUnit, kSettingLabel}; }

LabelKeys ParseLabelKeys(const std::string& list) {
  LabelKeys keys;
  std::stringstream words(list);
  for (std::string key; std::getline(words, key, ',');) keys.emplace_back(Trimmed(key));
  return keys;
}

std::string LabelKeysText(const LabelKeys& keys) { return Joined(keys, ","); }

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
    text += CountText(count, "recording has", "recordings have") + " no " + key + ": " +
            (count == 1 ? "it is" : "they are") + " in no group by " + key + "\n";
  }
  return text;
}

MeanScore MeanOfScores(const ScoreList& scores) {
  MeanScore mean;
  mean.recordings = mean.clusters = static_cast<int>(scores.size());
  if (scores.empty()) return mean;
  for (const Score* score : scores) mean.value += score->value;
  mean.value /= mean.recordings;
  // Sums of deviations: of people where some were pushed more than once, else of recordings.
  std::map<std::string, Metrics> people;
  Metrics squares = Metrics::Zero(), squares_of_people = Metrics::Zero();
  for (const Score* score : scores) {
    const Metrics deviation = (score->value - mean.value) / mean.recordings;
    squares += deviation * deviation;
    people.emplace(score->pushed, Metrics::Zero()).first->second += deviation;
  }
  for (const auto& [person, sum] : people) squares_of_people += sum * sum;
  if (people.size() > 1 && people.size() < scores.size()) {
    mean.clustered_by = ClusterBy::kSubject;
    mean.clusters = static_cast<int>(people.size());
    squares = squares_of_people;
  }
  if (mean.clusters > 1) mean.error = (squares * mean.clusters / (mean.clusters - 1.0)).sqrt();
  return mean;
}

ScoreMeans MeansOf(const std::vector<PendulumRecording>& recordings, const ScoreList& scores,
                   const LabelKeys& group_by) {
  ScoreMeans means;
  means.mean = MeanOfScores(Scored(scores));
  for (const std::string& key : group_by) {
    std::map<std::string, ScoreList> groups;
    int without = 0;
    for (size_t i = 0; i < scores.size(); ++i) {
      if (!scores[i]->failure.empty()) continue;
      const PendulumRecording& r = recordings[i];
      const std::string name =
          key == kSubjectUnit ? r.subject_ids[r.pushed_person] : r.labels.Of(key);
      if (name.empty()) ++without;
      if (!name.empty()) groups[name].push_back(scores[i]);
    }
    if (without > 0 && !groups.empty()) means.without_label[key] = without;
    auto& of_key = means.by[key];
    for (const auto& [name, group] : groups) of_key[name] = MeanOfScores(group);
  }
  return means;
}

ScoreSummary Summarize(const std::vector<PendulumRecording>& recordings,
                       std::vector<RecordingScore> scores, int observed, bool bands,
                       const LabelKeys& group_by) {
  ScoreList all;
  std::vector<StepPrediction> steps;
  std::vector<const PropagationScore*> propagation;
  for (size_t i = 0; i < recordings.size(); ++i) {
    scores[i].pushed = recordings[i].subject_ids[recordings[i].pushed_person];
    all.push_back(&scores[i]);
    if (!scores[i].failure.empty()) continue;
    steps.insert(steps.end(), scores[i].steps.begin(), scores[i].steps.end());
    propagation.push_back(&scores[i].propagation);
  }
  ScoreSummary summary;
  static_cast<ScoreMeans&>(summary) = MeansOf(recordings, all, group_by);
  summary.observed = observed;
  summary.bands = bands;
  summary.steps = ScoreSteps(steps);
  summary.propagation = SummarizePropagation(propagation);
  summary.recordings = std::move(scores);
  return summary;
}

}  // namespace pushid
