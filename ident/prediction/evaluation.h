// ident: prediction errors of a model and of the baselines.
//
// hipADE: mean over frames 1 .. T-1 and people of |hip predicted - hip measured|, in m; hipFDE: of
// the last frame. Means over recordings and, beside them, weighted by frames. Baselines:
// baselines.h, and where first frames were seen the model started anew there.
//
// Where the first k frames were seen (online_predictor.h), frame 0 among them, they are in every
// prediction as they were. after_hipADE is the mean over the frames behind them; inside90_x and
// inside90_y are the share of these in which the pushed person's hip lies in the 90 % band. The
// baselines then go on from frame k - 1.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "ident/figures/text_table.h"
#include "ident/prediction/baselines.h"
#include "ident/prediction/online_predictor.h"
#include "ident/prediction/predicted_steps.h"
#include "ident/prediction/prediction.h"
#include "ident/prediction/propagation.h"
#include "ident/prediction/score_groups.h"

namespace pushid {

// A new metric is a value here, a row in kHipMetrics and its formula in ScoreHip; means, files,
// tables, cross-validation and batches take it from there.
struct HipMetrics {
  double hip_ade = 0.0, hip_fde = 0.0;
  // Where first frames were seen; behind them, and in each third of these.
  double after_hip_ade = 0.0, first_third = 0.0, second_third = 0.0, last_third = 0.0;
  // Of the pushed person's bands.
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

// Those of predictions that have seen first frames, and of their bands.
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
// Those of files. bands: of models, not of baselines.
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
  std::string pushed = {};            // who was (PersonKey); Summarize fills it in
  // One per person; empty where the model says nothing of steps, and after a failure.
  std::vector<StepPrediction> steps = {};
  EffectEstimate effect = {};  // of the recording, where first frames were seen
  HipPaths predicted = {};     // of more than one person; groups are judged together
};

struct MeanScore : HipMetrics {
  int recordings = 0;
  HipMetrics error;  // standard error of the mean (score_groups.h)
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

// Who was predicted to step, and who did; empty where either is not known.
std::vector<StepPrediction> StepPredictions(const PendulumRecording& recording,
                                            const Prediction& prediction);

// Scores in the order of recordings; a failed rollout is a named failure.
// observed: frames seen first, 0: none; the model must say how recordings differ.
RecordingScore ScoreModel(const IdentifiedModel& model, const PendulumRecording& recording,
                          int observed = 0, ForecastUse use = ForecastUse::kStack);
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
                    ForecastUse use = ForecastUse::kStack);

}  // namespace pushid
