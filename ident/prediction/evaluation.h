// ident: prediction errors of a model and of the baselines.
//
// hipADE: mean over frames 1 .. T-1 and people of |hip predicted - hip measured|, in m; hipFDE: of
// the last frame. Means are over recordings.
//
// If the first k frames (including frame 0) were observed (online_predictor.h), every prediction
// contains them as recorded, after_hipADE is the mean over the later frames, and baselines start
// from frame k - 1. For predictions that are distributions (with observed frames, and the bands of
// futures.h), inside90_x and inside90_y are the shares of predicted frames in which the pushed
// person's hip lies in the 90 % band, and crps is the mean CRPS of x and y: lower is better.
#pragma once

#include <Eigen/Core>
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

// The metrics of hips, and those of bodies (defined in bodies/body_evaluation.h). A new metric is
// an entry and a row here and its formula in ScoreHip or ScoreBodies; means, files, tables,
// cross-validation and batches read it from this table.
enum MetricId : int {
  kHipAde,
  kHipFde,
  kAfterHipAde,  // after the observed frames, and in each third of the frames after them
  kFirstThird,
  kSecondThird,
  kLastThird,
  kInside90,  // coverage and CRPS of the pushed person's bands: x, then y
  kInside50 = kInside90 + 2,
  kCrps = kInside50 + 2,
  kMpjpe,
  kRelativeMpjpe,
  kMble,
  kFse,
  kNumMetrics
};
using Metrics = Eigen::Array<double, kNumMetrics, 1>;
using MetricList = std::vector<MetricId>;

struct Metric {
  const char* name;        // "hipADE"
  const char* unit;        // "m"
  bool with_error = true;  // files and tables have its standard error

  // The key in files: "hipADE_m".
  std::string Key() const { return std::string(name) + "_" + unit; }
  std::string ErrorKey() const { return std::string(name) + "_standard_error_" + unit; }
  // The head of a column: "after hipADE m".
  std::string Title() const;
  // The metric in a sentence: "hipADE 0.1 m".
  std::string Text(double value, int digits) const;
};
inline constexpr Metric kMetrics[kNumMetrics] = {
    {"hipADE", "m"},
    {"hipFDE", "m"},
    {"after_hipADE", "m"},
    {"first_third_hipADE", "m"},
    {"second_third_hipADE", "m"},
    {"last_third_hipADE", "m"},
    {"inside90_x", "share"},
    {"inside90_y", "share"},
    {"inside50_x", "share"},
    {"inside50_y", "share"},
    {"crps", "m"},
    {"MPJPE", "m"},
    {"relative_MPJPE", "m"},
    {"MBLE", "m", false},
    {"FSE", "cm", false},
};

// The metrics in tables of hips. observed: number of observed frames, 0: none. Predictors are
// compared by the first one if there is room for only one.
MetricList TableMetrics(int observed);
// Metrics of hips that files hold. bands: models have them, baselines do not.
MetricList MetricsOf(int observed, bool bands);
inline const MetricList kBodyMetrics = {kMpjpe, kHipAde, kHipFde, kRelativeMpjpe, kMble, kFse};

// "hipADE 0.1 m, hipFDE 0.2 m"
std::string MetricsText(const MetricList& metrics, const Metrics& values, int digits);

// Means of scores by label, and their standard errors.
//
// A person responds to every push with the same body and habits, so a model's errors are similar in
// all recordings of one person. If people were pushed more than once, the clusters of a standard
// error are therefore the pushed people, otherwise the recordings. Within one person they are
// recordings, and the error says nothing about other people. With G clusters and n scores,
//   error = sqrt(G / (G - 1) * sum over clusters of (sum of (score - mean) / n)^2)
// with Student's t of G - 1 degrees of freedom (CR1; covariance.h has the fit's).

// "4 people", "32 recordings"
std::string ClustersText(ClusterBy by, int count);

// Keys that scores are grouped by: `subject`, the pushed person, or any label of the manifest.
using LabelKeys = std::vector<std::string>;
LabelKeys UsualGroups();  // magnitude, subject, setting
// Keys from "setting,footwear", and back.
LabelKeys ParseLabelKeys(const std::string& list);
std::string LabelKeysText(const LabelKeys& keys);

// Error: a key other than `subject` that no recording has. The usual keys may be absent.
MaybeError CheckGroups(const std::vector<PendulumRecording>& recordings, const LabelKeys& keys);

// Predictions without a model. observed: frames seen first, frame 0 among them. 0: they begin at
// the end of the last push, or ten frames before the recording ends (half of a short recording);
// the static one begins at frame 0.
HipPaths StaticBaseline(const PendulumRecording& recording, int observed = 0);
// Every hip goes on from its last seen place with the velocity since the frame before.
HipPaths ConstantVelocityBaseline(const PendulumRecording& recording, int observed = 0);
// A quadratic through the last 0.23 s, whose acceleration fades with 0.25 s and whose velocity with
// 1 s.
HipPaths KinematicBaseline(const PendulumRecording& recording, int observed = 0);

struct Baseline {
  const char* name;
  const char* key;  // in files
  HipPaths (*predict)(const PendulumRecording&, int observed);
};
// The kinematic one is used only after observed frames.
std::vector<Baseline> Baselines(int observed);

// A prediction of a recording, of hips or of bodies.
struct Score {
  std::string id;
  int frames = 0, first_frame = 1;  // all, and the first that counts
  Metrics value = Metrics::Zero();
  std::string failure;      // why there is no score; such a recording is in no mean
  std::string pushed = {};  // id of that person; empty: errors of means are clustered by recordings
};
using ScoreList = std::vector<const Score*>;

struct RecordingScore : Score {
  bool fell = false;                  // a person leaned beyond 1.0 rad
  PropagationScore propagation = {};  // empty for a single person and after a failure
  // One value per person; empty where the model has no step probability, and after a failure.
  std::vector<StepPrediction> steps = {};
};

struct MeanScore {
  int recordings = 0;
  Metrics value = Metrics::Zero(), error = Metrics::Zero();  // mean and its standard error
  ClusterBy clustered_by = ClusterBy::kRecording;            // or kSubject
  int clusters = 0;
};
MeanScore MeanOfScores(const ScoreList& scores);

// A mean for each group: [key][text of the label], keys in the order of the list.
using MeansByLabel = nlohmann::ordered_map<std::string, std::map<std::string, MeanScore>>;

// The number of scores that lack the label of a key, by key, where others have it. Scores that
// failed do not count.
using WithoutLabel = std::map<std::string, int>;
// A line for each key: "2 recordings have no setting: they are in no group by setting"
std::string WithoutLabelText(const WithoutLabel& counts);

// Scores that failed are in no mean and in no group.
struct ScoreMeans {
  MeanScore mean;
  MeansByLabel by;
  WithoutLabel without_label;  // in no group of `by`
};
// scores in the order of recordings.
ScoreMeans MeansOf(const std::vector<PendulumRecording>& recordings, const ScoreList& scores,
                   const LabelKeys& group_by);

struct ScoreSummary : ScoreMeans {
  std::vector<RecordingScore> recordings;
  PropagationSummary propagation;  // over recordings of more than one person
  StepScore steps;                 // unknown if the model does not predict steps
  int observed = 0;                // number of observed frames
  bool bands = false;              // true where bands were scored
};

RecordingScore ScoreHip(const PendulumRecording& recording, const HipPaths& predicted,
                        int observed = 0);

// Errors: --observed below 1, or no frame left to predict in a recording, which is named.
MaybeError CheckObserved(const std::vector<PendulumRecording>& recordings, int observed);

// True where a person leans beyond kFallAngle.
bool AnybodyFalls(const Prediction& prediction);

// Predicted and recorded steps; empty where either is not known.
std::vector<StepPrediction> StepPredictions(const PendulumRecording& recording,
                                            const Prediction& prediction);

// Bands of drawn paths.
void ScoreDraws(const PendulumRecording& recording, const DrawnPaths& draws, RecordingScore* score);

// A rollout that fails is a score with a failure. observed: number of frames observed first, 0:
// none; otherwise the model must have learned forecasts.
RecordingScore ScoreModel(const IdentifiedModel& model, const PendulumRecording& recording,
                          int observed = 0, ForecastUse use = ForecastUse::kBoth);

ScoreSummary Summarize(const std::vector<PendulumRecording>& recordings,
                       std::vector<RecordingScore> scores, int observed = 0, bool bands = false,
                       const LabelKeys& group_by = UsualGroups());

// The scores of a baseline.
struct BaselineSummary {
  std::string name, key;
  ScoreSummary summary;
};

struct Evaluation {
  ScoreSummary model;
  std::vector<BaselineSummary> baselines;
  const ScoreSummary& Baseline(const std::string& key) const;  // one that there is
};
Evaluation Evaluate(const IdentifiedModel& model, const std::vector<PendulumRecording>& recordings,
                    int observed = 0, const LabelKeys& group_by = UsualGroups(),
                    ForecastUse use = ForecastUse::kBoth);

}  // namespace pushid
