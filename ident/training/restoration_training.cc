// ident: trainings of restorations, and what `window` and `cvae` learn from.
#include "ident/training/restoration_training.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "datasets/files/input_file.h"
#include "ident/bodies/restoration_files.h"
#include "ident/fit/fit.h"
#include "ident/prediction/prediction.h"
#include "ident/validation/crossvalidation.h"
#include "models/restoration/cvae_trainer.h"
#include "models/restoration/window_restoration.h"

namespace pushid {
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

}  // namespace pushid
