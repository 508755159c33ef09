// apps: flags of pushid-train-generator that train generators of diffusion alone.
#include <gflags/gflags.h>

#include "apps/flags/command_line.h"
#include "apps/flags/kind_flags.h"
#include "apps/flags/train_generator_flags.h"

namespace {
const pushid::DiffusionTrainingOptions kDiffusion;
}  // namespace

DEFINE_string(pooling, pushid::NameOf(kDiffusion.structure.pooling),
              "diffusion: interaction between people: local (by distance, ahead and behind), mean "
              "(all equal), attention, none");
DEFINE_double(bystanders, kDiffusion.bystanders,
              "diffusion: fraction of the training groups to which people far away are added");

namespace pushid {
namespace {

MaybeError ReadDiffusionFlags(TrainGeneratorFlags* flags) {
  DiffusionTrainingOptions& diffusion = flags->options.diffusion;
  for (const MaybeError& error :
       {ParseName("--pooling", FLAGS_pooling, &diffusion.structure.pooling),
        TakeInRange("bystanders", FLAGS_bystanders, 0.0, 1.0, &diffusion.bystanders)}) {
    if (error) return error;
  }
  if (flags->steps > 0) diffusion.steps = flags->steps;
  if (flags->batch > 0) diffusion.groups = flags->batch;
  if (flags->learning_rate > 0.0) diffusion.learning_rate = flags->learning_rate;
  return std::nullopt;
}

const KindFlags<TrainGeneratorFlags> kDiffusionFlags(GeneratorKind::kDiffusion,
                                                     {"pooling", "bystanders"}, ReadDiffusionFlags);

}  // namespace
}  // namespace pushid
