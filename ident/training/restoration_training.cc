#include "ident/training/restoration_training.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "ident/fit/fit.h"
#include "ident/prediction/online_predictor.h"
#include "ident/prediction/prediction.h"
#include "ident/problem/parallel.h"
#include "models/learned_terms.h"
#include "models/restoration/window_restoration.h"

namespace pushid {

std::vector<TrainingPoint> RunToEnd(Trainer* trainer,
                                    const std::function<void(TrainingPoint* point)>& told) {
  std::vector<TrainingPoint> curve;
  while (!trainer->Done()) {
    curve.push_back(trainer->RunRound());
    told(&curve.back());
  }
  return curve;
}

nlohmann::ordered_json CurveJson(const std::vector<TrainingPoint>& curve) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const TrainingPoint& p : curve) {
    nlohmann::ordered_json point = {{"epoch", p.epoch},
                                    {"training_loss", p.training_loss},
                                    {"held_out_loss", p.validation_loss}};
    if (!p.stage.empty()) point["stage"] = p.stage;
    json.push_back(point);
  }
  return json;
}

namespace {

int EpochsOf(int epochs, const RestorationTrainingOptions& options) {
  return std::max(1, static_cast<int>(std::lround(epochs * options.effort)));
}

// All frames of all samples as columns, scaled with `scaling`, which is set first if it is empty.
RegressionSamples WindowSamples(const std::vector<RestorationSample>& samples, RestorationView view,
                                Scaling* scaling) {
  int columns = 0;
  for (const RestorationSample& sample : samples) columns += static_cast<int>(sample.motion.size());
  RegressionSamples all;
  all.inputs.resize(WindowInputRows(view), columns);
  all.targets.resize(WindowOutputRows(view), columns);
  all.weights.resize(columns);
  int at = 0;
  for (const RestorationSample& sample : samples) {
    const int frames = static_cast<int>(sample.motion.size());
    all.inputs.middleCols(at, frames) =
        WindowInputs(*sample.people, sample.index, view).leftCols(frames);
    all.targets.middleCols(at, frames) = WindowTargets(sample.person(), sample.motion, view);
    all.weights.segment(at, frames).setConstant(static_cast<float>(sample.weight));
    at += frames;
  }
  if (scaling->mean.size() == 0) *scaling = ScalingOf(all.inputs);
  all.inputs = scaling->Scaled(all.inputs);
  return all;
}

std::vector<CvaeSequence> Sequences(const std::vector<RestorationSample>& samples,
                                    const CvaeLayout& layout) {
  std::vector<CvaeSequence> sequences;
  for (const RestorationSample& sample : samples) {
    const RestorationInput person = Resampled(sample.person(), 1.0 / kCvaeRate);
    const BodyMotion motion =
        Resampled(sample.motion, sample.person().dt, person.dt, static_cast<int>(person.q.size()));
    sequences.push_back({FramesOf(person, motion, layout), PendulumFrames(person, layout)});
  }
  return sequences;
}

// Scales the sequences; empty scalings are set first.
void Scale(std::vector<CvaeSequence>* sequences, CvaeWeights* scalings) {
  const auto scale = [&](Scaling* scaling, auto part) {
    if (scaling->mean.size() == 0) {
      Eigen::Index columns = 0, at = 0;
      for (CvaeSequence& s : *sequences) columns += part(s).cols();
      Eigen::MatrixXf all(part(sequences->front()).rows(), columns);
      for (CvaeSequence& s : *sequences) {
        all.middleCols(at, part(s).cols()) = part(s);
        at += part(s).cols();
      }
      *scaling = ScalingOf(all);
    }
    for (CvaeSequence& s : *sequences) part(s) = scaling->Scaled(part(s));
  };
  for (int half = 0; half < scalings->layout.num_halves(); ++half) {
    scale(&scalings->halves[half].scaling,
          [half](CvaeSequence& s) -> Eigen::MatrixXf& { return s.body[half]; });
  }
  if (!scalings->layout.pendulum) return;
  scale(&scalings->pendulum, [](CvaeSequence& s) -> Eigen::MatrixXf& { return s.pendulum; });
}

// LDP's release has the sizes of the autoencoders; the paper's Table 3 has totals only.
std::vector<NetworkSize> SizesOf(const CvaeTrainer& trainer, const CvaeLayout& layout) {
  constexpr int64_t kReleased[4] = {865536, 0, 1097904, 0};
  const std::array<int64_t, 4> parameters = trainer.NumParameters();
  std::vector<NetworkSize> sizes;
  for (size_t i = 0; i < parameters.size(); ++i) {
    if (parameters[i] == 0) continue;
    sizes.push_back({kCvaeStageNames[i], parameters[i], layout.halves ? kReleased[i] : 0});
  }
  return sizes;
}

}  // namespace

RestorationTraining TrainWindow(const std::vector<RestorationSample>& training,
                                const std::vector<RestorationSample>& held,
                                const RestorationTrainingOptions& options) {
  Scaling inputs;
  const RegressionSamples learnt = WindowSamples(training, options.view, &inputs);
  const RegressionSamples judged = WindowSamples(held, options.view, &inputs);
  RegressionOptions regression;
  regression.epochs = EpochsOf(regression.epochs, options);
  static_cast<TrainerOptions&>(regression) = options;
  const std::shared_ptr<TrainerOf<DenseNetwork>> trainer =
      MakeRegressionTrainer(learnt, judged, regression);
  const auto finish = [trainer, inputs, view = options.view](TensorFolder* content) {
    (*content->settings)[kViewKey] = NameOf(view);
    AddTensors("", WindowWeights{view, inputs, trainer->Network()}, &content->tensors);
  };
  return {trainer, finish};
}

RestorationTraining TrainCvae(const std::vector<RestorationSample>& training,
                              const std::vector<RestorationSample>& held,
                              const RestorationTrainingOptions& options) {
  CvaeWeights scalings;
  scalings.layout = {options.coordinates, options.view == RestorationView::kPendulum,
                     options.halves};
  std::vector<CvaeSequence> learnt = Sequences(training, scalings.layout);
  std::vector<CvaeSequence> judged = Sequences(held, scalings.layout);
  Scale(&learnt, &scalings);
  Scale(&judged, &scalings);
  CvaeOptions cvae;
  for (int& steps : cvae.steps) steps = EpochsOf(steps, options);
  cvae.training = options.training;
  static_cast<TrainerOptions&>(cvae) = options;
  const std::shared_ptr<CvaeTrainer> trainer = CvaeTrainer::Make(learnt, judged, scalings, cvae);
  const auto finish = [trainer, options](TensorFolder* content) {
    AddTensors("", trainer->Network(), &content->tensors);
    *content->settings = {{kViewKey, NameOf(options.view)},
                          {kCvaeCoordinatesKey, NameOf(options.coordinates)},
                          {kCvaeHalvesKey, options.halves},
                          {kCvaeTrainingKey, NameOf(options.training)}};
  };
  return {trainer, finish, SizesOf(*trainer, scalings.layout)};
}

Result<FittedFolds> FitFolds(const std::vector<PendulumRecording>& recordings,
                             const std::vector<int>& among, const FitOptions& options, int folds,
                             uint64_t seed, bool forecasts) {
  const std::vector<PendulumRecording> fitted = Picked(recordings, among);
  const int total = static_cast<int>(among.size());
  std::vector<std::vector<int>> held_out;
  if (folds > 0 && total > 1) {
    const auto made = MakeFolds(fitted, FoldScheme::kStratified, std::min(folds, total), 1, seed);
    if (!made.ok()) return made.error();
    for (const Fold& fold : made.value()) held_out.push_back(fold.held_out);
  }
  Result<FoldedModels> models = SolveFolds(fitted, options, held_out, forecasts);
  if (!models.ok()) return models.error();
  FittedFolds result{std::move(models.value().whole), {}};
  result.predictions.resize(total);
  for (size_t f = 0; f < held_out.size(); ++f) {
    const std::optional<IdentifiedModel>& model = models.value().without[f];
    for (size_t k = 0; model && k < held_out[f].size(); ++k) {
      Prediction prediction = Predict(*model, fitted[held_out[f][k]]);
      if (!prediction.status.ok) continue;
      prediction.forces = {}, prediction.hip.clear();
      result.predictions[held_out[f][k]] = std::move(prediction);
    }
  }
  return result;
}

void SplitHeldOut(const std::vector<PendulumRecording>& recordings, const std::vector<int>& among,
                  double share, uint64_t seed, std::vector<int>* training, std::vector<int>* held) {
  const int total = static_cast<int>(among.size());
  const int folds = std::clamp(static_cast<int>(std::lround(1.0 / share)), 2, std::max(2, total));
  const auto made = MakeFolds(Picked(recordings, among), FoldScheme::kStratified, folds, 1, seed);
  *held = made.ok() ? made.value()[0].held_out : std::vector<int>();
  *training = Others(*held, total);
}

namespace {

constexpr int kInnerFolds = 4;        // of the out-of-fold predictions
constexpr double kStopsEarly = 0.15;  // share of the recordings for early stopping
constexpr int kScoredDraws = 3;       // of the latent variable, whose scores are averaged

// Samples of every person of the recordings, with the recorded and the predicted pendulum (unless
// its path is empty), and both mirrored. predictions: in the order of `among`, or empty. rod_moves:
// as in RecordedPeople.
std::vector<RestorationSample> MakeSamples(const std::vector<BodyRecording>& recordings,
                                           const std::vector<int>& among,
                                           const std::vector<Prediction>& predictions,
                                           bool rod_moves, bool mirrored) {
  std::vector<RestorationSample> samples;
  const auto add = [&](const BodyRecording& recording, std::vector<RestorationInput> people) {
    const double weight = 100.0 / (recording.num_people() * recording.num_frames());
    std::vector<RestorationInput> others;
    for (const RestorationInput& person : people) others.push_back(Mirrored(person));
    const auto seen = std::make_shared<const std::vector<RestorationInput>>(std::move(people));
    const auto other = std::make_shared<const std::vector<RestorationInput>>(std::move(others));
    for (int n = 0; n < recording.num_people(); ++n) {
      samples.push_back({seen, n, recording.bodies[n], weight});
      if (!mirrored) continue;
      BodyMotion motion;
      for (const Pose& pose : recording.bodies[n]) motion.push_back(Mirrored(pose));
      samples.push_back({other, n, std::move(motion), weight});
    }
  };
  for (size_t k = 0; k < among.size(); ++k) {
    const BodyRecording& recording = recordings[among[k]];
    add(recording, RecordedPeople(recording, rod_moves));
    if (k >= predictions.size() || predictions[k].path.num_frames() == 0) continue;
    add(recording, PredictedPeople(recording, predictions[k]));
  }
  return samples;
}

// The scores of a restoration and its baselines (CrossValidateChain).
Result<BodyScores> ScoreTrained(const TensorFolder& content, const IdentifiedModel& model,
                                const RestorationRunOptions& options,
                                const BodyRecording& recording) {
  const auto restoration = MakeRestoration(content, "");
  if (!restoration.ok()) return restoration.error();
  const auto score = [&] {
    BodyScores scores;
    ScoreRestoration(model, *restoration.value(), options.postprocess, recording, &scores,
                     options.observed);
    return scores;
  };
  BodyScores scores = score();
  const RestorationTrainingOptions& training = options.training;
  if (training.kind != RestorationKind::kCvae || training.view == RestorationView::kPose) {
    return scores;
  }
  BodyScore mean;
  for (int k = 0; k < kScoredDraws; ++k) {
    const LatentChoice drawn = {CvaeLatent::kDraw, training.seed + k};
    if (MaybeError error = ChooseLatent(drawn, restoration.value().get())) return *error;
    const BodyScore one = score()["restoration"].front();
    if (k == 0) mean = one, mean.value.setZero();
    mean.value += one.value / static_cast<double>(kScoredDraws);
  }
  scores["restoration_drawn"] = {mean};
  return scores;
}

bool LearnsFromPredictions(const RestorationTrainingOptions& options) {
  return options.training != CvaeTraining::kPublished && options.view != RestorationView::kPose;
}

// Fits the pendulum, and predicts it out of fold if the training uses predictions.
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

// predictions: those of FittedFolds, or empty.
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
  const RestorationTrainingOptions& of_kind = options.training;
  const RestorationTraining prepared =
      kRestorationTrainers[static_cast<size_t>(of_kind.kind)](training, held, of_kind);
  Trainer* trainer = prepared.trainer.get();
  TrainedRestoration trained;
  trained.sizes = prepared.sizes;
  const auto told = [&](TrainingPoint* point) {
    if (!progress) return;
    progress(
        point->stage + (point->stage.empty() ? "" : ", ") + "epoch " + std::to_string(point->epoch),
        trainer->ShareDone());
  };
  trained.curve = RunToEnd(trainer, told);
  trained.content.kind = NameOf(of_kind.kind);
  prepared.finish(&trained.content);
  return trained;
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

Result<BodyValidation> CrossValidateBodies(const std::vector<BodyRecording>& recordings,
                                           const FoldChoice& choice, const FoldTrainer& train,
                                           const RunProgress& progress) {
  const auto made = MakeFolds(PendulumsOf(recordings), choice.scheme, choice.folds, 1, choice.seed);
  if (!made.ok()) return made.error();
  const int total = static_cast<int>(recordings.size());
  BodyValidation validation;
  std::vector<BodyScores> by_recording(total);
  for (const Fold& fold : made.value()) {
    const auto told = [&](const std::string& step, double done) {
      if (progress) progress(fold.name + ", " + step, done);
    };
    double seconds = 0.0;
    const Result<FoldScorer> score = train(Others(fold.held_out, total), told, &seconds);
    if (!score.ok()) {
      Error error = score.error();
      error.message = fold.name + ": " + error.message;
      return error;
    }
    validation.training_seconds.push_back(seconds);
    for (int i : fold.held_out) {
      Result<BodyScores> scores = score.value()(recordings[i]);
      if (!scores.ok()) return scores.error();
      by_recording[i] = std::move(scores.value());
    }
  }
  BodyScores all;
  for (const BodyScores& scores : by_recording) {
    for (const auto& [name, one] : scores) all[name].push_back(one.front());
  }
  validation.evaluation = SummarizeAll(recordings, all);
  return validation;
}

Result<BodyValidation> CrossValidateChain(const std::vector<BodyRecording>& recordings,
                                          const RestorationRunOptions& options,
                                          const FoldChoice& choice, const RunProgress& progress) {
  const std::vector<PendulumRecording> pendulums = PendulumsOf(recordings);
  const FoldTrainer train = [&](const std::vector<int>& among, const RunProgress& told,
                                double* seconds) -> Result<FoldScorer> {
    const double before = Now();
    Result<FittedFolds> pendulum = FitPendulum(pendulums, among, options, told);
    if (!pendulum.ok()) return pendulum.error();
    Result<TrainedRestoration> trained =
        TrainOn(recordings, pendulums, among, pendulum.value().predictions, options, told);
    if (!trained.ok()) return trained.error();
    *seconds = Now() - before;
    const auto model = std::make_shared<const IdentifiedModel>(std::move(pendulum.value().model));
    if (options.observed > 0) {
      if (MaybeError error = CheckLearnsFromFrames(*model)) return *error;
    }
    return FoldScorer(
        [&, model, content = std::move(trained.value().content)](const BodyRecording& recording) {
          return ScoreTrained(content, *model, options, recording);
        });
  };
  return CrossValidateBodies(recordings, choice, train, progress);
}

}  // namespace pushid
