// ident: scores of bodies and their means.
#include <algorithm>
#include <cmath>

#include "ident/bodies/body_evaluation.h"

namespace pushid {
namespace {

constexpr double kTouchHeight = 0.025;  // m
constexpr double kCentimetres = 100.0;  // per m

// The metrics of one person, but the FSE.
BodyMetrics ScorePerson(const BodyMotion& recorded, const BodyMotion& predicted, int first_frame) {
  BodyMetrics sum{};
  const int frames = static_cast<int>(recorded.size());
  for (int t = first_frame; t < frames; ++t) {
    const Pose error = predicted[t] - recorded[t];
    const Eigen::Vector3d hip = error.col(0);
    sum[kMpjpe] += error.colwise().norm().mean();
    sum[kHipAde] += hip.norm();
    sum[kMble] +=
        (BoneLengths(predicted[t]) - BoneLengths(recorded[t])).cwiseAbs().sum() / (kBodyJoints - 1);
    sum[kRelativeMpjpe] += (error.colwise() - hip).colwise().norm().mean();
    const Pose carried = recorded[t].colwise() + hip;
    sum[kBoundMpjpe] += (carried - recorded[t]).colwise().norm().mean();
  }
  for (double& value : sum) value /= frames - first_frame;
  sum[kHipFde] = (predicted.back() - recorded.back()).col(0).norm();
  return sum;
}

TimedError ErrorAt(const std::vector<BodyMotion>& recorded,
                   const std::vector<BodyMotion>& predicted, int frame) {
  TimedError error;
  const double people = static_cast<double>(recorded.size());
  for (size_t n = 0; n < recorded.size(); ++n) {
    const Pose difference = predicted[n][frame] - recorded[n][frame];
    const Eigen::Vector3d hip = difference.col(kBodyHip);
    error.root += hip.norm() / people;
    error.pose += (difference.colwise() - hip).colwise().norm().mean() / people;
  }
  return error;
}

TimedMean MeanAt(const std::vector<const BodyScore*>& scores, size_t second) {
  TimedMean at;
  for (const BodyScore* score : scores) {
    if (!score->at[second]) continue;
    ++at.recordings;
    at.mean.root += score->at[second]->root;
    at.mean.pose += score->at[second]->pose;
  }
  at.mean.root /= std::max(1, at.recordings);
  at.mean.pose /= std::max(1, at.recordings);
  return at;
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

using Scores = std::vector<const BodyScore*>;

BodyMean Mean(const Scores& scores, bool by_frames) {
  BodyMean mean;
  mean.recordings = static_cast<int>(scores.size());
  const auto weight = [by_frames](const BodyScore* s) {
    return by_frames ? static_cast<double>(s->frames - s->first_frame) : 1.0;
  };
  double total = 0.0;
  for (const BodyScore* s : scores) total += weight(s);
  const double n = static_cast<double>(scores.size());
  for (int m = 0; m < kNumBodyMetrics; ++m) {
    double squares = 0.0;
    for (const BodyScore* s : scores) mean.value[m] += weight(s) / total * s->value[m];
    for (const BodyScore* s : scores) {
      squares += std::pow(weight(s) / total * (s->value[m] - mean.value[m]), 2);
    }
    if (n > 1) mean.error[m] = std::sqrt(squares * n / (n - 1.0));
  }
  return mean;
}

}  // namespace

std::string MetricsText(const BodyMetrics& metrics, int digits) {
  std::string text;
  for (int m = 0; m < kNumBodyMetrics; ++m) {
    text += (m > 0 ? ", " : "") + kBodyMetrics[m].Text(metrics[m], digits);
  }
  return text;
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
  int touching = 0;
  for (int n = 0; n < people; ++n) {
    const BodyMetrics of_person = ScorePerson(recording.bodies[n], predicted[n], first_frame);
    for (int m = 0; m < kNumBodyMetrics; ++m) score.value[m] += of_person[m] / people;
    const double skate = FootSkate(predicted[n], first_frame);
    if (skate < 0.0) continue;
    score.value[kFse] += skate;
    ++touching;
  }
  score.value[kFse] /= std::max(1, touching);
  for (size_t i = 0; i < kErrorSeconds.size(); ++i) {
    const double after = kErrorSeconds[i] / recording.pendulum.scene.dt;
    const int frame = first_frame - 1 + static_cast<int>(std::lround(after));
    if (frame < score.frames) score.at[i] = ErrorAt(recording.bodies, predicted, frame);
  }
  if (people > 1) score.predicted = predicted;
  return score;
}

BodySummary SummarizeBodies(const std::vector<BodyRecording>& recordings,
                            std::vector<BodyScore> scores, const LabelKeys& group_by) {
  BodySummary summary;
  summary.recordings = std::move(scores);
  Scores all;
  std::vector<PendulumRecording> pendulums;
  for (size_t i = 0; i < recordings.size(); ++i) {
    pendulums.push_back(recordings[i].pendulum);
    if (summary.recordings[i].failure.empty()) all.push_back(&summary.recordings[i]);
  }
  summary.groups = GroupsOf(recordings, summary.recordings);
  summary.mean = Mean(all, false);
  summary.frame_weighted = Mean(all, true);
  for (size_t i = 0; i < summary.at.size(); ++i) summary.at[i] = MeanAt(all, i);
  summary.by = GroupScores(pendulums, summary.recordings, group_by,
                           [](const Scores& group) { return Mean(group, false); });
  summary.without_label = CountWithoutLabel(pendulums, summary.recordings, group_by);
  return summary;
}

}  // namespace pushid
