// ident: prediction errors of a model and of the baselines.
//
// hipADE: mean over frames 1 .. T-1 and people of |hip predicted - hip measured|, in m; hipFDE: of
// the last frame. Means over recordings and, beside them, weighted by frames. Baselines: static
// (no person moves) and constant velocity (the recording until the last push ends, then on with the
// last hip velocity).
#pragma once

#include <map>
#include <string>
#include <vector>

#include "ident/figures/metric.h"
#include "ident/prediction/prediction.h"
#include "ident/prediction/propagation.h"
#include "ident/prediction/score_clusters.h"
#include "ident/prediction/step_score.h"

namespace pushid {

// A new metric is a value here, a row in kHipMetrics and its formula in ScoreHip; means, files,
// tables, cross-validation and batches take it from there.
struct HipMetrics {
  double hip_ade = 0.0, hip_fde = 0.0;
};

struct HipMetric : Metric {
  double HipMetrics::*value;
};

// The first is the one that predictors are compared by where there is room for one.
inline constexpr HipMetric kHipMetrics[] = {
    {{"hipADE", "m"}, &HipMetrics::hip_ade},
    {{"hipFDE", "m"}, &HipMetrics::hip_fde},
};

// "hipADE 0.1 m, hipFDE 0.2 m"
std::string MetricsText(const HipMetrics& metrics, int digits);

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
};

struct MeanScore : HipMetrics {
  int recordings = 0;
  HipMetrics error;  // standard error of the mean (score_clusters.h)
  ClusterBy clustered_by = ClusterBy::kRecording;
  int clusters = 0;
};

struct ScoreSummary {
  std::vector<RecordingScore> recordings;
  MeanScore mean, frame_weighted;
  std::map<std::string, MeanScore> by_magnitude, by_subject, by_setting;
  PropagationSummary propagation;  // over recordings of more than one person
  std::map<std::string, PropagationSummary> propagation_by_setting;  // none for single people
  StepScore steps;  // unknown where the model says nothing of them
};

// Hip positions over time: [person][frame].
using HipPaths = std::vector<std::vector<Vector3<double>>>;
RecordingScore ScoreHip(const PendulumRecording& recording, const HipPaths& predicted);

HipPaths StaticBaseline(const PendulumRecording& recording);
HipPaths ConstantVelocityBaseline(const PendulumRecording& recording);

// Who was predicted to step, and who did; empty where either is not known.
std::vector<StepPrediction> StepPredictions(const PendulumRecording& recording,
                                            const Prediction& prediction);

// Scores in the order of recordings; a failed rollout is a named failure.
RecordingScore ScoreModel(const IdentifiedModel& model, const PendulumRecording& recording);

// Whether anybody falls with every push times 1.4, until 40 frames past the recording's end.
bool FallsWhenPushedHarder(const IdentifiedModel& model, const PendulumRecording& recording);

// `by subject` uses the pushed person.
ScoreSummary Summarize(const std::vector<PendulumRecording>& recordings,
                       std::vector<RecordingScore> scores);

struct Evaluation {
  ScoreSummary model, static_baseline, constant_velocity;
};
Evaluation Evaluate(const IdentifiedModel& model, const std::vector<PendulumRecording>& recordings);

}  // namespace pushid
