// ident: what the peers learn from: windows of the true motions for siMLPe, whole groups for MRT.
#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "ident/bodies/restoration_kinds.h"
#include "ident/peers/peer_files.h"
#include "ident/training/restoration_training.h"
#include "models/peers/mrt_trainer.h"
#include "models/peers/simlpe.h"

namespace pushid {
namespace {

constexpr int kSimlpeEpochs = 40;

Error TooShort(RestorationKind kind) {
  return Error{"the recordings are too short for --kind=" + NameOf(kind)};
}

RegressionSamples Windows(const std::vector<RestorationSample>& samples, Scaling* scaling) {
  std::vector<Eigen::VectorXf> inputs, targets;
  std::vector<float> weights;
  for (const RestorationSample& sample : samples) {
    const BodyMotion motion = AtPeerRate(sample.motion, sample.person().dt);
    for (int last = kSimlpeGiven - 1; last + kSimlpeFrames < static_cast<int>(motion.size());
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

// Samples of the same people, who stand side by side, are one group.
std::vector<MrtGroup> MrtGroups(const std::vector<RestorationSample>& samples) {
  std::vector<MrtGroup> groups;
  std::map<const void*, size_t> known;
  for (const RestorationSample& sample : samples) {
    const auto [at, is_new] = known.try_emplace(sample.people.get(), groups.size());
    if (is_new) groups.push_back({std::vector<BodyMotion>(sample.people->size()), sample.weight});
    groups[at->second].people[sample.index] = AtPeerRate(sample.motion, sample.person().dt);
  }
  return groups;
}

}  // namespace

Result<RestorationTraining> TrainSimlpe(const std::vector<RestorationSample>& training,
                                        const std::vector<RestorationSample>& held,
                                        const RestorationTrainingOptions& options) {
  SimlpeWeights weights;
  const RegressionSamples learnt = Windows(training, &weights.inputs);
  const RegressionSamples judged = Windows(held, &weights.inputs);
  if (learnt.inputs.cols() == 0 || judged.inputs.cols() == 0) return TooShort(options.kind);
  const auto trainer = DenseTrainer(learnt, judged, kSimlpeEpochs, options);
  const auto finish = [trainer, weights](RestorationFile* file) {
    AddTensors(SimlpeWeights{weights.inputs, trainer->Best()}, &file->tensors);
  };
  return RestorationTraining{trainer, finish};
}

Result<RestorationTraining> TrainMrt(const std::vector<RestorationSample>& training,
                                     const std::vector<RestorationSample>& held,
                                     const RestorationTrainingOptions& options) {
  std::vector<MrtGroup> learnt = MrtGroups(training), judged = MrtGroups(held);
  if (std::none_of(learnt.begin(), learnt.end(), HasWindow) ||
      std::none_of(judged.begin(), judged.end(), HasFrameAfter)) {
    return TooShort(options.kind);
  }
  MrtOptions mrt;
  mrt.size = options.mrt_size;
  mrt.epochs = EpochsOf(mrt.epochs, options);
  static_cast<TrainerOptions&>(mrt) = options;
  const auto trainer = std::make_shared<MrtTrainer>(std::move(learnt), std::move(judged), mrt);
  const auto finish = [trainer, size = mrt.size](RestorationFile* file) {
    (*file->settings)[kMrtSizeKey] = NameOf(size);
    AddTensors(trainer->Best(), &file->tensors);
  };
  return RestorationTraining{trainer, finish};
}

}  // namespace pushid
