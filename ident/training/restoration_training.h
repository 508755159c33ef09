// ident: training of restorations, from recordings on, and its cross-validation; and what all
// trainings share. Needs LibTorch (behind models/).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "ident/bodies/body_evaluation.h"
#include "ident/bodies/body_recording.h"
#include "ident/bodies/restoration_files.h"
#include "ident/model/identified_model.h"
#include "ident/problem/folds.h"
#include "models/restoration/restoration.h"
#include "models/restoration/trainer.h"

namespace pushid {

// Runs the trainer to its end; the points of its curve. told: about every new point, whose stage it
// may name.
std::vector<TrainingPoint> RunToEnd(Trainer* trainer,
                                    const std::function<void(TrainingPoint* point)>& told);

// The curve in the file of what was trained.
nlohmann::ordered_json CurveJson(const std::vector<TrainingPoint>& curve);

// Restorations learn from recorded bodies with their true pendulums and with pendulums that a model
// predicts without having seen the recording. A network in use gets predicted pendulums, which have
// errors; so it is trained on both. The predictions are out of fold: a model fitted to the very
// recording would err too little.

// The model of `options` fitted to some recordings, without the uncertainty; and for every one of
// them what a model predicts which was fitted without its fold (ident/fit/fit.h), without forces
// and hips: an empty path where the rollout failed.
struct FittedFolds {
  IdentifiedModel model;
  std::vector<Prediction> predictions;  // in the order of `among`
};
// among: indices. Fewer recordings than folds: one fold each. 0 folds: no predictions. forecasts:
// as in SolveModel. Errors: those of SolveModel; folds that cannot be made.
Result<FittedFolds> FitFolds(const std::vector<PendulumRecording>& recordings,
                             const std::vector<int>& among, const FitOptions& options, int folds,
                             uint64_t seed, bool forecasts = false);

// One person of one recording with one pendulum, among everybody of the recording.
struct RestorationSample {
  std::shared_ptr<const std::vector<RestorationInput>> people;
  int index = 0;        // who of them
  BodyMotion motion;    // the true one
  double weight = 1.0;  // of a frame: recordings count alike

  const RestorationInput& person() const { return (*people)[index]; }
};

// Indices into `among`'s values: about `share` of the recordings, at least one, spread over
// settings and strengths, to stop a training early by.
void SplitHeldOut(const std::vector<PendulumRecording>& recordings, const std::vector<int>& among,
                  double share, uint64_t seed, std::vector<int>* training, std::vector<int>* held);

struct RestorationTrainingOptions : TrainerOptions {
  RestorationKind kind = RestorationKind::kWindow;
  RestorationView view = RestorationView::kPendulum;    // of kWindow and kCvae
  CvaeCoordinates coordinates = CvaeCoordinates::kTip;  // of kCvae
  bool halves = true;                                   // of kCvae: lower, then upper body
  CvaeTraining training = CvaeTraining::kOwn;           // of kCvae
  double effort = 1.0;                                  // multiplies the number of steps
};

// A network, how many numbers it learns, and how many in its paper's release; 0: not known.
struct NetworkSize {
  std::string name;
  int64_t parameters = 0, released = 0;
};

struct TrainedRestoration {
  std::vector<TrainingPoint> curve;
  TensorFolder content;
  std::vector<NetworkSize> sizes;
};

// A training that a kind's own function has prepared (ident/bodies/restoration_files.h).
struct RestorationTraining {
  std::shared_ptr<Trainer> trainer;
  std::function<void(TensorFolder* content)> finish;  // settings and tensors of the trained
  std::vector<NetworkSize> sizes{};
};

// A whole training from recordings: pendulums predicted out of fold, samples, held-out recordings.

struct RestorationRunOptions {
  FitOptions fit;  // of the pendulum
  RestorationTrainingOptions training;
  PostprocessOptions postprocess;
  int observed = 0;  // frames that held-out recordings show first (prediction/online_predictor.h)
  // Recordings of other settings to learn from too, with their recorded pendulums; never judged.
  std::vector<BodyRecording> more;
};

// The choice of folds, and the seed of what is drawn.
struct FoldChoice {
  FoldScheme scheme = FoldScheme::kStratified;
  int folds = 0;
  uint64_t seed = 1;
};

// step: "pendulum 2/4", "window epoch 12"; done: share of this step.
using RunProgress = std::function<void(const std::string& step, double done)>;

// Learns from the recordings with these indices.
Result<TrainedRestoration> TrainFromRecordings(const std::vector<BodyRecording>& recordings,
                                               const std::vector<int>& among,
                                               const RestorationRunOptions& options,
                                               const RunProgress& progress = nullptr);

// Cross-validation of bodies: everything is trained anew for every fold, so that nothing has seen
// the recordings it is judged on.

struct BodyValidation {
  BodyEvaluation evaluation;  // every recording as predicted by the fold that did not see it
  std::vector<double> training_seconds;  // by fold
};

// Scores of one held-out recording, one of each name.
using FoldScorer = std::function<Result<BodyScores>(const BodyRecording& recording)>;
// Trains on the recordings with these indices.
using FoldTrainer = std::function<Result<FoldScorer>(const std::vector<int>& among,
                                                     const RunProgress& progress, double* seconds)>;
// Errors: folds that cannot be made; those of the trainer and of its scorers.
Result<BodyValidation> CrossValidateBodies(const std::vector<BodyRecording>& recordings,
                                           const FoldChoice& choice, const FoldTrainer& train,
                                           const RunProgress& progress);

// The whole chain. Of a cvae, restoration_drawn has the mean of the scores of three draws of the
// latent variable, and restoration is by its mean. Errors also: a fold whose pendulum fit finds no
// optimum, or which cannot learn from first frames where some are to be seen.
Result<BodyValidation> CrossValidateChain(const std::vector<BodyRecording>& recordings,
                                          const RestorationRunOptions& options,
                                          const FoldChoice& choice,
                                          const RunProgress& progress = nullptr);

}  // namespace pushid
