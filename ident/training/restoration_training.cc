// ident: trainings run, with checkpoints: key, curve and state, each with its length in front.
#include "ident/training/restoration_training.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "datasets/files/atomic_file.h"
#include "datasets/files/input_file.h"
#include "datasets/files/number_text.h"
#include "ident/figures/chart.h"
#include "ident/fit/fit.h"
#include "ident/prediction/online_predictor.h"
#include "ident/prediction/prediction.h"
#include "ident/problem/parallel.h"
#include "models/learned_terms.h"
#include "models/restoration/window_restoration.h"

namespace pushid {
namespace {

constexpr double kCheckpointSeconds = 20.0;  // between two

void Append(const std::string& part, std::string* bytes) {
  const uint64_t size = part.size();
  bytes->append(reinterpret_cast<const char*>(&size), sizeof size);
  *bytes += part;
}

bool Take(const std::string& bytes, size_t* at, std::string* part) {
  uint64_t size = 0;
  if (bytes.size() < *at + sizeof size) return false;
  std::memcpy(&size, bytes.data() + *at, sizeof size);
  *at += sizeof size;
  if (bytes.size() - *at < size) return false;
  *part = bytes.substr(*at, size);
  *at += size;
  return true;
}

// The state and the curve so far; false where there is no checkpoint with this key.
bool Load(const std::string& path, const std::string& wanted_key, std::string* state,
          std::vector<TrainingPoint>* curve) {
  std::error_code ignored;
  if (path.empty() || !std::filesystem::exists(path, ignored)) return false;
  const Result<std::string> bytes = ReadWholeFile(path);
  if (!bytes.ok()) return false;
  size_t at = 0;
  std::string key, points;
  if (!Take(bytes.value(), &at, &key) || key != wanted_key) return false;
  if (!Take(bytes.value(), &at, &points) || !Take(bytes.value(), &at, state)) return false;
  const auto json = nlohmann::json::parse(points, nullptr, false);
  if (!json.is_array()) return false;
  for (const auto& p : json) {
    if (!p.is_array() || p.size() != 4) return false;
    curve->push_back(
        {p[0].get<int>(), p[1].get<double>(), p[2].get<double>(), p[3].get<std::string>()});
  }
  return true;
}

MaybeError Save(const std::string& path, const std::string& key, const std::string& state,
                const std::vector<TrainingPoint>& curve) {
  nlohmann::json points = nlohmann::json::array();
  for (const TrainingPoint& p : curve) {
    points.push_back({p.epoch, p.training_loss, p.validation_loss, p.stage});
  }
  std::string bytes;
  Append(key, &bytes);
  Append(points.dump(), &bytes);
  Append(state, &bytes);
  return WriteFileAtomically(path, bytes);
}

constexpr double kCurveWidth = 700;  // pixels
constexpr char kTraining[] = "stroke:#2a788e", kHeldOut[] = "stroke:#d1495b";

ChartLine LossLine(const std::vector<TrainingPoint>& stage, double TrainingPoint::*loss,
                   const char* look) {
  ChartLine line;
  line.look = std::string("fill:none;stroke-width:2;") + look;
  for (const TrainingPoint& p : stage) line.points.emplace_back(p.epoch, p.*loss);
  return line;
}

// Stages have names where the training loss and the held-out one (m) have different units, and a
// panel each.
void AddPanels(const std::vector<TrainingPoint>& stage, std::vector<Chart>* panels) {
  const ChartLine training = LossLine(stage, &TrainingPoint::training_loss, kTraining);
  const auto best = std::min_element(stage.begin(), stage.end(), [](const auto& a, const auto& b) {
    return a.validation_loss < b.validation_loss;
  });
  Chart chart{stage.front().stage, "epoch"};
  chart.y_from = 0.0;
  if (!chart.title.empty()) {
    panels->push_back(chart);
    panels->back().lines = {training};
    chart.y_label = "m";
  } else {
    chart.lines = {training};
  }
  chart.x_label +=
      ", best " + Rounded(best->validation_loss, 3) + " at " + std::to_string(best->epoch);
  chart.lines.push_back(LossLine(stage, &TrainingPoint::validation_loss, kHeldOut));
  chart.marks = {static_cast<double>(best->epoch)};
  panels->push_back(chart);
}

}  // namespace

MaybeError RunToEnd(Trainer* trainer, const std::string& key, const CheckpointOptions& options,
                    const std::function<void(TrainingPoint* point)>& told, TrainingCourse* course) {
  double last = Now() - kCheckpointSeconds;  // the first is due at once
  std::string state;
  std::vector<TrainingPoint> curve;
  if (Load(options.checkpoint, key, &state, &curve) && trainer->Resume(state)) {
    course->resumed = true;
  } else {
    curve.clear();
  }
  while (!trainer->Done()) {
    curve.push_back(trainer->RunRound());
    told(&curve.back());
    const bool due = trainer->Done() ? options.keep_finished : Now() - last >= kCheckpointSeconds;
    if (options.checkpoint.empty() || !due) continue;
    last = Now();
    if (MaybeError error = Save(options.checkpoint, key, trainer->State(), curve)) return error;
  }
  course->curve.insert(course->curve.end(), curve.begin(), curve.end());
  return std::nullopt;
}

void RemoveCheckpoint(const std::string& file) {
  std::error_code ignored;
  if (!file.empty()) std::filesystem::remove(file, ignored);
}

std::string TrainingCurveSvg(const std::vector<TrainingPoint>& curve, const std::string& title) {
  Figure figure{{{"training", kTraining}, {"held-out recordings", kHeldOut}}, {}, title};
  for (size_t from = 0, to = 0; from < curve.size(); from = to) {
    while (to < curve.size() && curve[to].stage == curve[from].stage) ++to;
    AddPanels({curve.begin() + static_cast<std::ptrdiff_t>(from),
               curve.begin() + static_cast<std::ptrdiff_t>(to)},
              &figure.panels);
  }
  return DrawFigure(figure, kCurveWidth, title).ToString();
}

namespace {

// A hash of everything the samples hold.
std::string KeyOfSamples(const std::vector<RestorationSample>& samples) {
  ContentHash hash;
  const auto add = [&hash](const auto& values) {
    hash.Add({reinterpret_cast<const char*>(values.data()),
              static_cast<size_t>(values.size()) * sizeof(double)});
  };
  for (const RestorationSample& sample : samples) {
    add(sample.person().first_pose);
    for (const auto& q : sample.person().q) add(q);
    for (const auto& lengths : sample.person().lengths) add(lengths);
    add(sample.person().push.velocity);
    add(sample.person().push.place);
    for (const Pose& pose : sample.motion) add(pose);
  }
  return hash.Hex();
}

// What a training depends on.
std::string KeyOfTraining(const std::vector<RestorationSample>& training,
                          const std::vector<RestorationSample>& held,
                          const RestorationTrainingOptions& options) {
  return "2 " + NameOf(options.kind) + " " + NameOf(options.coordinates) + " " +
         NameOf(options.view) + (options.halves ? " halves " : " whole ") +
         NameOf(options.training) + " " + std::to_string(options.effort) + " " +
         std::to_string(options.seed) + " " + KeyOfSamples(training) + KeyOfSamples(held);
}

// All frames of all samples side by side; scaled with `scaling`, which is set first if it is empty.
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
    BodyFrames frames = FramesOf(person, motion, layout);
    sequences.push_back(
        {std::move(frames.lower), std::move(frames.upper), PendulumFrames(person, layout)});
  }
  return sequences;
}

Scaling ScalingOfAll(const std::vector<CvaeSequence>& sequences,
                     Eigen::MatrixXf CvaeSequence::*part) {
  Eigen::Index columns = 0, at = 0;
  for (const CvaeSequence& s : sequences) columns += (s.*part).cols();
  Eigen::MatrixXf all((sequences.front().*part).rows(), columns);
  for (const CvaeSequence& s : sequences) {
    all.middleCols(at, (s.*part).cols()) = s.*part;
    at += (s.*part).cols();
  }
  return ScalingOf(all);
}

void Scale(const CvaeWeights& scalings, std::vector<CvaeSequence>* sequences) {
  for (CvaeSequence& s : *sequences) {
    s.lower = scalings.lower.Scaled(s.lower);
    if (scalings.layout.halves) s.upper = scalings.upper.Scaled(s.upper);
    if (scalings.layout.pendulum) s.pendulum = scalings.pendulum.Scaled(s.pendulum);
  }
}

// Beside the two halves' autoencoders in LDP's release; the paper's Table 3 has totals only.
std::vector<NetworkSize> SizesOf(const CvaeTrainer& trainer, const CvaeLayout& layout) {
  constexpr int64_t kReleased[4] = {865536, 0, 1097904, 0};
  std::vector<NetworkSize> sizes;
  for (size_t i = 0; i < trainer.NumParameters().size(); ++i) {
    const int64_t parameters = trainer.NumParameters()[i];
    if (parameters == 0) continue;
    sizes.push_back({kCvaeStageNames[i], parameters, layout.halves ? kReleased[i] : 0});
  }
  return sizes;
}

}  // namespace

Result<RestorationTraining> TrainWindow(const std::vector<RestorationSample>& training,
                                        const std::vector<RestorationSample>& held,
                                        const RestorationTrainingOptions& options) {
  Scaling inputs;
  const RegressionSamples learnt = WindowSamples(training, options.view, &inputs);
  const RegressionSamples judged = WindowSamples(held, options.view, &inputs);
  RegressionOptions regression;
  regression.epochs = EpochsOf(regression.epochs, options);
  static_cast<TrainerOptions&>(regression) = options;
  const auto trainer = std::make_shared<RegressionTrainer>(learnt, judged, regression);
  const auto finish = [trainer, inputs, view = options.view](RestorationFile* file) {
    (*file->settings)[kViewKey] = NameOf(view);
    AddTensors("inputs", inputs, &file->tensors);
    AddTensors("network", trainer->Best(), &file->tensors);
  };
  return RestorationTraining{trainer, finish};
}

Result<RestorationTraining> TrainCvae(const std::vector<RestorationSample>& training,
                                      const std::vector<RestorationSample>& held,
                                      const RestorationTrainingOptions& options) {
  CvaeWeights scalings;
  scalings.layout = {options.coordinates, options.view == RestorationView::kPendulum,
                     options.halves};
  std::vector<CvaeSequence> learnt = Sequences(training, scalings.layout);
  std::vector<CvaeSequence> judged = Sequences(held, scalings.layout);
  scalings.lower = ScalingOfAll(learnt, &CvaeSequence::lower);
  if (scalings.layout.halves) scalings.upper = ScalingOfAll(learnt, &CvaeSequence::upper);
  if (scalings.layout.pendulum) scalings.pendulum = ScalingOfAll(learnt, &CvaeSequence::pendulum);
  Scale(scalings, &learnt);
  Scale(scalings, &judged);
  CvaeOptions cvae;
  for (int& steps : cvae.steps) steps = EpochsOf(steps, options);
  cvae.training = options.training;
  static_cast<TrainerOptions&>(cvae) = options;
  const auto trainer =
      std::make_shared<CvaeTrainer>(std::move(learnt), std::move(judged), scalings, cvae);
  const auto finish = [trainer, options](RestorationFile* file) {
    file->tensors = ToTensors(trainer->Best());
    *file->settings = {{kViewKey, NameOf(options.view)},
                       {kCvaeCoordinatesKey, NameOf(options.coordinates)},
                       {kCvaeHalvesKey, options.halves},
                       {kCvaeTrainingKey, NameOf(options.training)}};
  };
  return RestorationTraining{trainer, finish, SizesOf(*trainer, scalings.layout)};
}

nlohmann::ordered_json SizesJson(const std::vector<NetworkSize>& sizes) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const NetworkSize& size : sizes) json[size.name] = size.parameters;
  return json;
}

std::string SizesText(const std::vector<NetworkSize>& sizes) {
  std::string text;
  for (const NetworkSize& size : sizes) {
    text += size.name + ": " + std::to_string(size.parameters) + " parameters";
    if (size.released > 0) text += " (release: " + std::to_string(size.released) + ")";
    text += "\n";
  }
  return text;
}

int EpochsOf(int epochs, const RestorationTrainingOptions& options) {
  return std::max(1, static_cast<int>(std::lround(epochs * options.effort)));
}

Result<TrainedRestoration> TrainRestoration(const std::vector<RestorationSample>& training,
                                            const std::vector<RestorationSample>& held,
                                            const RestorationTrainingOptions& options,
                                            const TrainingProgress& progress) {
  for (const KindTrainer& row : kRestorationTrainers) {
    if (row.kind != options.kind) continue;
    const Result<RestorationTraining> of_kind = row.train(training, held, options);
    if (!of_kind.ok()) return of_kind.error();
    Trainer* trainer = of_kind.value().trainer.get();
    TrainedRestoration trained;
    trained.sizes = of_kind.value().sizes;
    const auto told = [&](TrainingPoint* point) {
      if (progress) progress(*point, trainer->ShareDone());
    };
    if (MaybeError error =
            RunToEnd(trainer, KeyOfTraining(training, held, options), options, told, &trained)) {
      return *error;
    }
    RemoveCheckpoint(options.checkpoint);
    trained.file.kind = options.kind;
    of_kind.value().finish(&trained.file);
    return trained;
  }
  return Error{"--kind is '" + NameOf(options.kind) + "', which is not trained; it must be " +
               TrainedRestorationKinds()};
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
