// ident: prediction errors of a model and of the baselines.
//
// hipADE: mean over frames 1 .. T-1 and people of |hip predicted - hip measured|, in m; hipFDE: of
// the last frame. Means over recordings and, beside them, weighted by frames. Baselines:
// kBaselines, and where first frames were seen the model started anew there.
//
// Where the first k frames were seen (online_predictor.h), frame 0 among them, they are in every
// prediction as they were. after_hipADE is the mean over the frames behind them, and the baselines
// go on from frame k - 1. Of predictions that are distributions (there, and of drawn paths)
// inside90_x and inside90_y are the share of the predicted frames in which the pushed person's hip
// lies in the 90 % band, crps the mean of the CRPS of x and y: the lower, the better.
#pragma once

#include <map>
#include <nlohmann/ordered_map.hpp>
#include <string>
#include <vector>

#include "datasets/loading/pendulum_recording.h"
#include "ident/figures/text_table.h"
#include "ident/model/model_rollout.h"
#include "ident/parameters/fit_options.h"
#include "ident/prediction/futures.h"
#include "ident/prediction/online_predictor.h"
#include "ident/prediction/predicted_steps.h"
#include "ident/prediction/prediction.h"
#include "ident/prediction/propagation.h"
#include "ident/problem/statistics.h"

namespace pushid {

// Scores by label, and whose scores are independent of each other: the standard errors of
// their means.
//
// A person answers every push with the same body and habits, and a model misses one person's
// recordings alike. So where people were pushed more than once the clusters of a mean's error are
// the pushed people, otherwise the recordings; within one person they are recordings, which says
// nothing about anybody else. With G clusters and scores of weights w that sum to 1,
//   error = sqrt(G / (G - 1) * sum over clusters of (sum of w (score - mean))^2)
// with Student's t of G - 1 degrees of freedom (CR1; clusters.h has the fit's).

struct ScoreClusters {
  ClusterBy by = ClusterBy::kRecording;  // or kSubject
  int count = 0;
  std::vector<int> of;  // cluster of each score

  // deviations: w (score - mean) of each. 0 of a single cluster.
  double ErrorOfMean(const std::vector<double>& deviations) const;
  // Mean of one value for each score, all of one weight.
  MeanAndError Mean(const std::vector<double>& values) const;
};

// pushed: who was pushed, for each score (ids).
ScoreClusters ClustersOf(const std::vector<std::string>& pushed);
ScoreClusters ClustersOf(const std::vector<PendulumRecording>& recordings);

// "4 people", "32 recordings"
std::string ClustersText(ClusterBy by, int count);

// What scores are grouped by: `subject`, who was pushed, or any label that a manifest gives.
using LabelKeys = std::vector<std::string>;
LabelKeys UsualGroups();  // magnitude, subject, setting
// From "setting,footwear", and back.
LabelKeys ParseLabelKeys(const std::string& list);
std::string LabelKeysText(const LabelKeys& keys);

// Error: a key that is not `subject` and that no recording has; not of the usual ones.
MaybeError CheckGroups(const std::vector<PendulumRecording>& recordings, const LabelKeys& keys);

// What recordings are called by a key, one text each; empty where they have no such label.
std::vector<std::string> GroupNames(const std::vector<PendulumRecording>& recordings,
                                    const std::string& key);

// A value for each group: [key][text of the label], keys in the order of the list.
template <typename T>
using ByLabel = nlohmann::ordered_map<std::string, std::map<std::string, T>>;

// of: the value of a list of scores. Scores that failed are in no group.
template <typename Score, typename Of>
auto GroupScores(const std::vector<PendulumRecording>& recordings, const std::vector<Score>& scores,
                 const LabelKeys& keys, Of of) {
  using Group = std::vector<const Score*>;
  ByLabel<decltype(of(Group()))> by;
  for (const std::string& key : keys) {
    const std::vector<std::string> names = GroupNames(recordings, key);
    std::map<std::string, Group> groups;
    for (size_t i = 0; i < scores.size(); ++i) {
      if (scores[i].failure.empty() && !names[i].empty()) groups[names[i]].push_back(&scores[i]);
    }
    auto& of_key = by[key];
    for (const auto& [name, group] : groups) of_key[name] = of(group);
  }
  return by;
}

// By key: how many scores are in none of its groups, for want of the label; only where others have
// it. Scores that failed do not count.
using WithoutLabel = std::map<std::string, int>;

template <typename Score>
WithoutLabel CountWithoutLabel(const std::vector<PendulumRecording>& recordings,
                               const std::vector<Score>& scores, const LabelKeys& keys) {
  WithoutLabel counts;
  for (const std::string& key : keys) {
    const std::vector<std::string> names = GroupNames(recordings, key);
    int with = 0, without = 0;
    for (size_t i = 0; i < scores.size(); ++i) {
      if (scores[i].failure.empty()) ++(names[i].empty() ? without : with);
    }
    if (with > 0 && without > 0) counts[key] = without;
  }
  return counts;
}

// A line for each key: "2 recordings have no setting: they are in no group by setting"
std::string WithoutLabelText(const WithoutLabel& counts);

// Predictions that ask no model.

// observed: frames seen first, frame 0 among them; 0: until the last push ends, or the last frame
// but ten (half of a short recording); of the static one frame 0 alone.
HipPaths StaticBaseline(const PendulumRecording& recording, int observed = 0);
// Everybody goes on from the last seen place with the velocity since the frame before.
HipPaths ConstantVelocityBaseline(const PendulumRecording& recording, int observed = 0);
// A quadratic through the last 0.23 s, whose acceleration fades with 0.25 s and whose velocity with
// 1 s.
HipPaths KinematicBaseline(const PendulumRecording& recording, int observed = 0);

struct Baseline {
  const char* name;
  const char* key;  // in files
  HipPaths (*predict)(const PendulumRecording&, int observed);
  bool needs_frames;  // only where first frames were seen
};
inline constexpr Baseline kBaselines[] = {
    {"static", "static", StaticBaseline, false},
    {"constant velocity", "constant_velocity", ConstantVelocityBaseline, false},
    {"kinematic", "kinematic", KinematicBaseline, true},
};

// A new metric is a value here, a row in kHipMetrics and its formula in ScoreHip; means, files,
// tables, cross-validation and batches take it from there.
struct HipMetrics {
  double hip_ade = 0.0, hip_fde = 0.0;
  // Where first frames were seen; behind them, and in each third of these.
  double after_hip_ade = 0.0, first_third = 0.0, second_third = 0.0, last_third = 0.0;
  // Coverage and CRPS of the pushed person's bands.
  double inside90_x = 0.0, inside90_y = 0.0, inside50_x = 0.0, inside50_y = 0.0, crps = 0.0;
};

struct HipMetric : Metric {
  double HipMetrics::*value;
};

// The first is the one that predictors are compared by where there is room for one.
inline constexpr HipMetric kHipMetrics[] = {
    {{"hipADE", "m"}, &HipMetrics::hip_ade},
    {{"hipFDE", "m"}, &HipMetrics::hip_fde},
};

// Metrics of predictions that have seen first frames, and of distributions.
inline constexpr HipMetric kAfterMetric = {{"after_hipADE", "m"}, &HipMetrics::after_hip_ade};
inline constexpr HipMetric kThirdMetrics[] = {
    {{"first_third_hipADE", "m"}, &HipMetrics::first_third},
    {{"second_third_hipADE", "m"}, &HipMetrics::second_third},
    {{"last_third_hipADE", "m"}, &HipMetrics::last_third},
};
inline constexpr HipMetric kBandMetrics[] = {
    {{"inside90_x", "share"}, &HipMetrics::inside90_x},
    {{"inside90_y", "share"}, &HipMetrics::inside90_y},
    {{"inside50_x", "share"}, &HipMetrics::inside50_x},
    {{"inside50_y", "share"}, &HipMetrics::inside50_y},
    {{"crps", "m"}, &HipMetrics::crps},
};

using ShownMetrics = std::vector<HipMetric>;

// The metrics of tables. observed: frames that were seen, 0: none.
ShownMetrics TableMetrics(int observed);
// Metrics that files hold. bands: models have them, baselines do not.
ShownMetrics MetricsOf(int observed, bool bands);
inline ShownMetrics AllHipMetrics() { return MetricsOf(1, true); }

// "hipADE 0.1 m, hipFDE 0.2 m"
std::string MetricsText(const HipMetrics& metrics, int digits, int observed = 0);

struct RecordingScore : HipMetrics {
  std::string id;
  int frames = 0;
  std::string failure;                // why there is no score; such a recording is in no mean
  bool fell = false;                  // a person leaned beyond 1.0 rad
  bool fell_harder = false;           // FallsWhenPushedHarder, where it was asked
  PropagationScore propagation = {};  // empty for a single person and after a failure
  std::string pushed = {};            // whose id; Summarize fills it in
  // One per person; empty where the model says nothing of steps, and after a failure.
  std::vector<StepPrediction> steps = {};
  HipPaths predicted = {};  // of more than one person; groups are judged together
};

struct MeanScore : HipMetrics {
  int recordings = 0;
  HipMetrics error;  // standard error of the mean (Summarize)
  ClusterBy clustered_by = ClusterBy::kRecording;
  int clusters = 0;
};

struct ScoreSummary {
  std::vector<RecordingScore> recordings;
  MeanScore mean, frame_weighted;
  ByLabel<MeanScore> by;
  WithoutLabel without_label;      // in no group of `by`, or of the propagation by setting
  PropagationSummary propagation;  // over recordings of more than one person
  std::map<std::string, PropagationSummary> propagation_by_setting;  // none for single people
  StepScore steps;     // unknown where the model says nothing of them
  int observed = 0;    // frames that were seen, where it was asked for
  bool bands = false;  // whether they were scored
};

RecordingScore ScoreHip(const PendulumRecording& recording, const HipPaths& predicted,
                        int observed = 0);

// Errors: --observed below 1, or no frame left to predict in a recording, which is named.
MaybeError CheckObserved(const std::vector<PendulumRecording>& recordings, int observed);

// Whether anybody leans beyond kFallAngle.
bool AnybodyFalls(const Prediction& prediction);

// Predicted and recorded steps; empty where either is not known.
std::vector<StepPrediction> StepPredictions(const PendulumRecording& recording,
                                            const Prediction& prediction);

// Bands of drawn paths.
void ScoreDraws(const PendulumRecording& recording, const DrawnPaths& draws, RecordingScore* score);

// How many futures are drawn from frame 0, and from which seed on (futures.h); none: no bands.
struct Draws {
  int count = 0;
  uint64_t seed = 1;
};

// Scores in the order of recordings; a failed rollout is a named failure, and so are fewer than two
// futures. observed: frames seen first, 0: none; the model must say how recordings differ.
RecordingScore ScoreModel(const IdentifiedModel& model, const PendulumRecording& recording,
                          int observed = 0, ForecastUse use = ForecastUse::kBoth,
                          const Draws& draws = {});
RecordingScore ScoreReanchored(const IdentifiedModel& model, const PendulumRecording& recording,
                               int observed);

// Whether anybody falls with every push times 1.4, until 40 frames past the recording's end.
bool FallsWhenPushedHarder(const IdentifiedModel& model, const PendulumRecording& recording);

ScoreSummary Summarize(const std::vector<PendulumRecording>& recordings,
                       std::vector<RecordingScore> scores, int observed = 0, bool bands = false,
                       const LabelKeys& group_by = UsualGroups());

// What a model has to beat.
struct BaselineSummary {
  std::string name, key;
  ScoreSummary summary;
};

struct Evaluation {
  ScoreSummary model;
  // kBaselines, and where first frames were seen the model started there anew.
  std::vector<BaselineSummary> baselines;
  const ScoreSummary& Baseline(const std::string& key) const;  // one that there is
};
Evaluation Evaluate(const IdentifiedModel& model, const std::vector<PendulumRecording>& recordings,
                    int observed = 0, const LabelKeys& group_by = UsualGroups(),
                    ForecastUse use = ForecastUse::kBoth, const Draws& draws = {});

}  // namespace pushid
