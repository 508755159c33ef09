// ident: trainings from recordings.
#include "ident/training/restoration_chain.h"

#include <algorithm>

#include "ident/bodies/body_recording.h"
#include "ident/prediction/online_predictor.h"
#include "ident/problem/parallel.h"
#include "ident/validation/crossvalidation.h"
#include "models/learned_terms.h"

namespace pushid {
namespace {

constexpr int kInnerFolds = 4;        // of the out-of-fold predictions
constexpr double kStopsEarly = 0.15;  // share of the recordings that stop the training early
constexpr int kScoredDraws = 3;       // of the latent variable, whose scores are averaged

// Metric by metric; a failure is a failure of all.
BodyScore MeanOfDraws(const std::vector<BodyScore>& scores) {
  BodyScore mean = scores.front();
  mean.value.setZero();
  for (const BodyScore& score : scores) {
    mean.value += score.value / static_cast<double>(scores.size());
  }
  return mean;
}

// The restoration of the predicted pendulums alone, as restoration_drawn.
void ScoreDrawn(const IdentifiedModel& model, const Restoration& restoration,
                const RestorationRunOptions& options, const BodyRecording& recording,
                BodyScores* scores) {
  BodyScores of_draw;
  ScoreRestoration(model, restoration, options.postprocess, recording, &of_draw, options.observed);
  (*scores)["restoration_drawn"].push_back(of_draw["restoration"].front());
}

// A restoration beside its baselines; of a cvae also with a drawn latent variable.
Result<BodyScores> ScoreTrained(const RestorationFile& file, const IdentifiedModel& model,
                                const RestorationRunOptions& options,
                                const BodyRecording& recording) {
  BodyScores scores;
  const auto restoration = MakeRestoration(file, "");
  if (!restoration.ok()) return restoration.error();
  ScoreRestoration(model, *restoration.value(), options.postprocess, recording, &scores,
                   options.observed);
  if (file.kind != RestorationKind::kCvae || options.training.view == RestorationView::kPose) {
    return scores;
  }
  for (int k = 0; k < kScoredDraws; ++k) {
    const LatentChoice drawn = {CvaeLatent::kDraw, options.training.seed + k};
    if (MaybeError error = ChooseLatent(drawn, restoration.value().get())) return *error;
    ScoreDrawn(model, *restoration.value(), options, recording, &scores);
  }
  scores["restoration_drawn"] = {MeanOfDraws(scores["restoration_drawn"])};
  return scores;
}

bool LearnsFromPredictions(const RestorationTrainingOptions& options) {
  return options.training != CvaeTraining::kPublished && options.view != RestorationView::kPose;
}

// The pendulum, and what is predicted of it out of fold where that is learned from.
Result<FittedFolds> FitPendulum(const std::vector<PendulumRecording>& pendulums,
                                const std::vector<int>& among, const RestorationRunOptions& options,
                                const RunProgress& progress) {
  if (progress) progress("fitting the pendulum, and without each fold", 0.0);
  Result<FittedFolds> fitted = FitFolds(pendulums, among, options.fit,
                                        LearnsFromPredictions(options.training) ? kInnerFolds : 0,
                                        options.training.seed, options.observed > 0);
  if (!fitted.ok()) return Error{"the pendulum's fit: " + fitted.error().message};
  return fitted;
}

// predictions: as FittedFolds, or none.
Result<TrainedRestoration> TrainOn(const std::vector<BodyRecording>& recordings,
                                   const std::vector<PendulumRecording>& pendulums,
                                   const std::vector<int>& among,
                                   const std::vector<Prediction>& predictions,
                                   const RestorationRunOptions& options,
                                   const RunProgress& progress) {
  std::vector<int> learnt, judged;
  SplitHeldOut(pendulums, among, kStopsEarly, options.training.seed, &learnt, &judged);
  if (learnt.empty() || judged.empty()) {
    return Error{
        "there are too few recordings to train on and to hold out for early stopping; at least two "
        "are needed"};
  }
  const bool rod_moves = RodMoves(options.fit.model);
  auto training =
      MakeSamples(recordings, Picked(among, learnt), Picked(predictions, learnt), rod_moves, true);
  for (RestorationSample& sample : MakeSamples(
           options.more, Others({}, static_cast<int>(options.more.size())), {}, rod_moves, true)) {
    training.push_back(std::move(sample));
  }
  const auto held =
      MakeSamples(recordings, Picked(among, judged), Picked(predictions, judged), rod_moves, false);
  return TrainRestoration(training, held, options.training,
                          [&](const TrainingPoint& point, double done) {
                            if (!progress) return;
                            progress(point.stage + (point.stage.empty() ? "" : ", ") + "epoch " +
                                         std::to_string(point.epoch),
                                     done);
                          });
}

}  // namespace

Result<TrainedRestoration> TrainFromRecordings(const std::vector<BodyRecording>& recordings,
                                               const std::vector<int>& among,
                                               const RestorationRunOptions& options,
                                               const RunProgress& progress) {
  const std::vector<PendulumRecording> pendulums = PendulumsOf(recordings);
  std::vector<Prediction> predictions;
  if (LearnsFromPredictions(options.training)) {
    Result<FittedFolds> fitted = FitPendulum(pendulums, among, options, progress);
    if (!fitted.ok()) return fitted.error();
    predictions = std::move(fitted.value().predictions);
  }
  return TrainOn(recordings, pendulums, among, predictions, options, progress);
}

Result<TrainedChain> TrainChain(const std::vector<BodyRecording>& recordings,
                                const std::vector<int>& among, const RestorationRunOptions& options,
                                const RunProgress& progress) {
  const std::vector<PendulumRecording> pendulums = PendulumsOf(recordings);
  RestorationRunOptions alone = options;
  alone.training.checkpoint.clear();  // one would be of one training, not of the whole
  Result<FittedFolds> pendulum = FitPendulum(pendulums, among, alone, progress);
  if (!pendulum.ok()) return pendulum.error();
  Result<TrainedRestoration> trained =
      TrainOn(recordings, pendulums, among, pendulum.value().predictions, alone, progress);
  if (!trained.ok()) return trained.error();
  return TrainedChain{std::move(pendulum.value().model), std::move(trained.value())};
}

Result<ChainValidation> CrossValidateChain(const std::vector<BodyRecording>& recordings,
                                           const RestorationRunOptions& options, FoldScheme scheme,
                                           int folds, const RunProgress& progress) {
  const std::vector<PendulumRecording> pendulums = PendulumsOf(recordings);
  const int total = static_cast<int>(recordings.size());
  const auto made = MakeFolds(pendulums, scheme, folds, 1, options.training.seed);
  if (!made.ok()) return made.error();
  ChainValidation validation;
  std::vector<std::map<std::string, BodyScore>> by_recording(total);
  for (const Fold& fold : made.value()) {
    const std::vector<int> train = Others(fold.held_out, total);
    const auto told = [&](const std::string& step, double done) {
      if (progress) progress(fold.name + ", " + step, done);
    };
    const double before = Now();
    Result<TrainedChain> chain = TrainChain(recordings, train, options, told);
    if (!chain.ok()) return Error{fold.name + ": " + chain.error().message};
    validation.training_seconds.push_back(Now() - before);
    const IdentifiedModel& model = chain.value().model;
    if (options.observed > 0) {
      if (MaybeError error = CheckLearnsFromFrames(model)) return *error;
    }
    for (int i : fold.held_out) {
      const Result<BodyScores> scores =
          ScoreTrained(chain.value().restoration.file, model, options, recordings[i]);
      if (!scores.ok()) return scores.error();
      for (const auto& [name, of_name] : scores.value()) by_recording[i][name] = of_name.front();
    }
  }
  validation.evaluation = SummarizeAll(recordings, by_recording);
  return validation;
}

}  // namespace pushid
