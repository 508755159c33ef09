// ident: what MRT learns from: the true motions of whole groups.
#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "ident/bodies/restoration_files.h"
#include "ident/peers/peer_files.h"
#include "ident/training/restoration_training.h"
#include "models/peers/mrt_trainer.h"

namespace pushid {
namespace {

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

Result<RestorationTraining> TrainMrt(const std::vector<RestorationSample>& training,
                                     const std::vector<RestorationSample>& held,
                                     const RestorationTrainingOptions& options) {
  std::vector<MrtGroup> learnt = MrtGroups(training), judged = MrtGroups(held);
  if (std::none_of(learnt.begin(), learnt.end(), HasWindow) ||
      std::none_of(judged.begin(), judged.end(), HasFrameAfter)) {
    return Error{"the recordings are too short for --kind=" + NameOf(options.kind)};
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
