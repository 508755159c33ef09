// ident: how well a configuration predicts recordings it has not seen.
//
// The standard error of a mean is over pushed people, or over recordings where nobody was pushed
// twice (evaluation.h), each recording's score averaged over the repeats: not over frames and
// not over folds.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "ident/prediction/evaluation.h"
#include "ident/problem/behaviour.h"
#include "ident/problem/folds.h"
#include "ident/problem/parallel.h"

namespace pushid {

// The outcome of one fold.
struct FoldPrediction {
  std::vector<RecordingScore> scores;  // one per test recording
  std::optional<Behaviour> behaviour;  // of the model fitted on the others, if one was
};

// Predicted hips of the held-out recordings after fitting on the others; train and test: indices
// into recordings.
struct Predictor {
  std::string name;
  std::function<FoldPrediction(const std::vector<PendulumRecording>& recordings,
                               const std::vector<int>& train, const std::vector<int>& test)>
      fit_and_score;
  int observed = 0;    // frames that predictions see first; 0: none
  bool bands = false;  // true where predictions come with bands
};

struct FoldScore {
  std::string name;
  Metrics value = Metrics::Zero();  // means over the fold's recordings
  int held_out = 0;
  int failures = 0, falls = 0;
  std::optional<Behaviour> behaviour;
};

struct CrossValidation {
  std::string predictor;
  std::vector<FoldScore> folds;
  // Scores of each recording are averaged over the repeats that held it out.
  ScoreSummary summary;
  int failures = 0, falls = 0;  // over all folds
  // Number of folds whose model was fitted, and of those that settle in every settling simulation;
  // the fastest anybody still is two seconds after a push.
  int fits = 0, settling = 0;
  double slowest_to_settle = 0.0;  // m/s
};

CrossValidation CrossValidate(const std::vector<PendulumRecording>& recordings,
                              const std::vector<Fold>& folds, const Predictor& predictor,
                              int num_threads, const JobProgress& progress = nullptr,
                              const LabelKeys& group_by = UsualGroups());

// b minus a, recording by recording, with the standard error of its mean.
struct PairedDifference : MeanScore {
  std::string a, b;
  int observed = 0;
};
PairedDifference Compare(const CrossValidation& a, const CrossValidation& b);

// The predictors compared: an identified model, and the baselines that any model has to beat.

// Fits the pendulum model to the training recordings, and to them what first frames tell. observed:
// as in ScoreModel.
Predictor ModelPredictor(const std::string& name, FitOptions options, int observed = 0,
                         ForecastUse use = ForecastUse::kBoth);

// A fit's rollouts with their predictive bands.
Predictor BandPredictor(const std::string& name, FitOptions options, const BandOptions& bands);

// A baseline; nothing is fitted.
Predictor BaselinePredictor(const Baseline& baseline, int observed = 0);

// The mean displacement of the pushed hip by condition and frame, along the push, across and
// upwards: where a push takes people, however hard it is.
Predictor TemplatePredictor();

// Ridge regression from the pushed person's mass, rod length, x-impulse over mass and push frames
// to the displacement of the hip at every frame (paths padded with their last value): no mechanics
// at all.
Predictor RidgePredictor();

}  // namespace pushid
