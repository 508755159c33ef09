// ident: training of restorations from recordings, its cross-validation, and functions for all
// trainings. Needs LibTorch (behind models/).
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

// Runs the trainer to its end and returns its curve. told: called with each new point, whose stage
// it may change.
std::vector<TrainingPoint> RunToEnd(Trainer* trainer,
                                    const std::function<void(TrainingPoint* point)>& told);

// The curve as in generator.json and restoration.json.
nlohmann::ordered_json CurveJson(const std::vector<TrainingPoint>& curve);

// Restorations are trained on recorded bodies with their recorded pendulums, and with pendulums
// that are predicted out of fold: in use, the pendulums are predicted and have errors. The errors
// of a model fitted to the same recording would be too small.

// A model fitted to some recordings (without uncertainty), and the prediction of each recording by
// a model fitted without its fold (ident/fit/fit.h), without forces and hips; its path is empty if
// the rollout failed.
struct FittedFolds {
  IdentifiedModel model;
  std::vector<Prediction> predictions;  // in the order of `among`
};
// among: indices of recordings. folds: at most one per recording; 0: no predictions. forecasts: as
// in SolveModel. Errors: those of SolveModel; folds that cannot be made.
Result<FittedFolds> FitFolds(const std::vector<PendulumRecording>& recordings,
                             const std::vector<int>& among, const FitOptions& options, int folds,
                             uint64_t seed, bool forecasts = false);

// One person of a recording, with the recorded or a predicted pendulum.
struct RestorationSample {
  std::shared_ptr<const std::vector<RestorationInput>> people;
  int index = 0;        // of the person
  BodyMotion motion;    // recorded
  double weight = 1.0;  // of a frame; all recordings have the same total

  const RestorationInput& person() const { return (*people)[index]; }
};

// Splits `among` into recordings for training and for early stopping (about `share` of them, at
// least one, spread over settings and strengths); indices into `among`.
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

// A network's number of parameters, and that in the paper's release (0: unknown).
struct NetworkSize {
  std::string name;
  int64_t parameters = 0, released = 0;
};

struct TrainedRestoration {
  std::vector<TrainingPoint> curve;
  TensorFolder content;
  std::vector<NetworkSize> sizes;
};

// A training as a kind's function prepares it (ident/bodies/restoration_files.h).
struct RestorationTraining {
  std::shared_ptr<Trainer> trainer;
  std::function<void(TensorFolder* content)> finish;  // sets settings and tensors
  std::vector<NetworkSize> sizes{};
};

struct RestorationRunOptions {
  FitOptions fit;  // of the pendulum
  RestorationTrainingOptions training;
  PostprocessOptions postprocess;
  int observed = 0;  // observed frames of held-out recordings (prediction/online_predictor.h)
  // Training recordings of other settings, with their recorded pendulums; they are not scored.
  std::vector<BodyRecording> more;
};

struct FoldChoice {
  FoldScheme scheme = FoldScheme::kStratified;
  int folds = 0;
  uint64_t seed = 1;
};

// step: for example "fold 2, epoch 12"; done: share of this step.
using RunProgress = std::function<void(const std::string& step, double done)>;

// among: indices of the recordings to train on.
Result<TrainedRestoration> TrainFromRecordings(const std::vector<BodyRecording>& recordings,
                                               const std::vector<int>& among,
                                               const RestorationRunOptions& options,
                                               const RunProgress& progress = nullptr);

// Cross-validation of bodies: everything is trained again in every fold, without the recordings
// that it is scored on.

struct BodyValidation {
  BodyEvaluation evaluation;             // of each recording in the fold that holds it out
  std::vector<double> training_seconds;  // by fold
};

// Scores of one held-out recording, one for each name.
using FoldScorer = std::function<Result<BodyScores>(const BodyRecording& recording)>;
// Trains on the recordings with these indices.
using FoldTrainer = std::function<Result<FoldScorer>(const std::vector<int>& among,
                                                     const RunProgress& progress, double* seconds)>;
// Errors: folds that cannot be made; those of the trainer and of its scorers.
Result<BodyValidation> CrossValidateBodies(const std::vector<BodyRecording>& recordings,
                                           const FoldChoice& choice, const FoldTrainer& train,
                                           const RunProgress& progress);

// The pendulum's fit and the restoration. With kCvae, "restoration" uses the mean of the latent
// variable, and "restoration_drawn" has the mean scores of three draws. Further errors: a fold
// whose pendulum's fit does not converge, or which cannot learn forecasts if frames are observed.
Result<BodyValidation> CrossValidateChain(const std::vector<BodyRecording>& recordings,
                                          const RestorationRunOptions& options,
                                          const FoldChoice& choice,
                                          const RunProgress& progress = nullptr);

}  // namespace pushid
