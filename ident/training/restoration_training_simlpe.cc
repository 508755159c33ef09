// ident: windows of the true motions for siMLPe.
#include "ident/bodies/simlpe_files.h"
#include "ident/training/restoration_training_checkpoint.h"
#include "ident/training/restoration_training_kinds.h"
#include "models/restoration/cvae_features.h"

namespace pushid {
namespace {

constexpr int kSimlpeEpochs = 40;
constexpr double kSimlpeStep = 1.0 / 60.0;  // s

RegressionSamples Windows(const std::vector<RestorationSample>& samples, Scaling* scaling) {
  std::vector<Eigen::VectorXf> inputs, targets;
  std::vector<float> weights;
  for (const RestorationSample& sample : samples) {
    const double end = static_cast<double>(sample.motion.size() - 1) * sample.person().dt;
    const BodyMotion motion = Resampled(sample.motion, sample.person().dt, kSimlpeStep,
                                        static_cast<int>(end / kSimlpeStep + 0.5) + 1);
    for (int last = kGivenFrames - 1; last + kSimlpeFrames < static_cast<int>(motion.size());
         ++last) {
      inputs.push_back(SimlpeInput(motion, last));
      targets.push_back(SimlpeTarget(motion, last));
      weights.push_back(static_cast<float>(sample.weight));
    }
  }
  const int count = static_cast<int>(inputs.size());
  RegressionSamples all{Eigen::MatrixXf(kSimlpeInputs, count),
                        Eigen::MatrixXf(kSimlpeOutputs, count),
                        Eigen::Map<Eigen::VectorXf>(weights.data(), count)};
  for (int i = 0; i < count; ++i) all.inputs.col(i) = inputs[i], all.targets.col(i) = targets[i];
  if (scaling->mean.size() == 0 && count > 0) *scaling = ScalingOf(all.inputs);
  if (count > 0) all.inputs = scaling->Scaled(all.inputs);
  return all;
}

}  // namespace

Result<TrainedRestoration> TrainSimlpe(const std::vector<RestorationSample>& training,
                                       const std::vector<RestorationSample>& held,
                                       const RestorationTrainingOptions& options,
                                       const TrainingProgress& progress) {
  SimlpeWeights weights;
  const RegressionSamples learnt = Windows(training, &weights.inputs);
  if (learnt.inputs.cols() == 0) return Error{"the recordings are too short for --kind=simlpe"};
  const RegressionSamples judged = Windows(held, &weights.inputs);
  if (judged.inputs.cols() == 0) return Error{"the recordings are too short for --kind=simlpe"};
  TrainedRestoration trained;
  const Result<DenseNetwork> network =
      TrainDense(learnt, judged, kSimlpeEpochs, KeyOfTraining(training, held, options), options,
                 progress, &trained);
  if (!network.ok()) return network.error();
  weights.network = network.value();
  AddTensors(weights, &trained.file.tensors);
  return trained;
}

}  // namespace pushid
