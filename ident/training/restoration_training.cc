// ident: samples to tensors, epochs, checkpoints.
#include "ident/training/restoration_training.h"

#include <nlohmann/json.hpp>

#include "ident/training/restoration_training_kinds.h"
#include "models/restoration/window_features.h"
#include "models/restoration/window_restoration.h"

namespace pushid {
namespace {

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

constexpr int kWindowEpochs = 40;

Result<TrainedRestoration> TrainWindow(const std::vector<RestorationSample>& training,
                                       const std::vector<RestorationSample>& held,
                                       const RestorationTrainingOptions& options,
                                       const TrainingProgress& progress) {
  WindowWeights weights;
  const RegressionSamples learnt = WindowSamples(training, options.view, &weights.inputs);
  const RegressionSamples judged = WindowSamples(held, options.view, &weights.inputs);
  TrainedRestoration trained;
  const Result<DenseNetwork> network =
      TrainDense(learnt, judged, kWindowEpochs, KeyOfTraining(training, held, options), options,
                 progress, &trained);
  if (!network.ok()) return network.error();
  (*trained.file.settings)[kViewKey] = NameOf(options.view);
  AddTensors("inputs", weights.inputs, &trained.file.tensors);
  AddTensors("network", network.value(), &trained.file.tensors);
  return trained;
}

}  // namespace

Result<DenseNetwork> TrainDense(const RegressionSamples& learnt, const RegressionSamples& judged,
                                int epochs, const std::string& key,
                                const RestorationTrainingOptions& options,
                                const TrainingProgress& progress, TrainedRestoration* trained) {
  RegressionOptions regression;
  regression.epochs = EpochsOf(epochs, options);
  regression.seed = options.seed;
  regression.num_threads = options.num_threads;
  RegressionTrainer trainer(learnt, judged, regression);
  if (MaybeError error = RunEpochs(&trainer, regression.epochs, key, options, progress, trained)) {
    return *error;
  }
  return trainer.Best();
}

namespace {

struct Trainer {
  RestorationKind kind;
  Result<TrainedRestoration> (*train)(const std::vector<RestorationSample>& training,
                                      const std::vector<RestorationSample>& held,
                                      const RestorationTrainingOptions& options,
                                      const TrainingProgress& progress);
};

constexpr Trainer kTrainers[] = {
    {RestorationKind::kWindow, TrainWindow},
    {RestorationKind::kCvae, TrainCvae},
    {RestorationKind::kSimlpe, TrainSimlpe},
    {RestorationKind::kMrt, TrainMrt},
};

}  // namespace

Result<TrainedRestoration> TrainRestoration(const std::vector<RestorationSample>& training,
                                            const std::vector<RestorationSample>& held,
                                            const RestorationTrainingOptions& options,
                                            const TrainingProgress& progress) {
  for (const Trainer& trainer : kTrainers) {
    if (trainer.kind != options.kind) continue;
    Result<TrainedRestoration> trained = trainer.train(training, held, options, progress);
    if (trained.ok()) trained.value().file.kind = options.kind;
    return trained;
  }
  return Error{std::string("--kind is '") + Name(options.kind) +
               "', which is not trained; it must be " + TrainedRestorationKinds()};
}

}  // namespace pushid
