// apps: flags of pushid-train-generator that train siMLPe, alone and in the blend with particles.
#include <gflags/gflags.h>

#include "apps/flags/command_line.h"
#include "apps/flags/kind_flags.h"
#include "apps/flags/train_generator_flags.h"

namespace {
const pushid::SimlpeTrainingOptions kSimlpe;
const pushid::GeneratorTrainingOptions kBlend;
}  // namespace

DEFINE_int32(blocks, kSimlpe.blocks, "simlpe: number of blocks; the paper has 48");

DEFINE_double(simlpe_share, kBlend.simlpe_share,
              "cmu: share of siMLPe, which it comes to in the far future; 0: none");
DEFINE_int32(simlpe_steps, kSimlpe.steps, "cmu: training steps of the siMLPe that is blended with");

namespace pushid {
namespace {

void ReadSimlpeFlags(TrainGeneratorFlags* flags) {
  SimlpeTrainingOptions& simlpe = flags->options.simlpe;
  simlpe.steps = FLAGS_simlpe_steps;
  if (flags->options.kind == GeneratorKind::kSimlpe && flags->steps > 0) {
    simlpe.steps = flags->steps;
  }
  if (flags->batch > 0) simlpe.batch = flags->batch;
  if (flags->learning_rate > 0.0) simlpe.learning_rate = flags->learning_rate;
  CheckRange("simlpe_steps", FLAGS_simlpe_steps, 1, 1e6);
  TakeInRange("simlpe_share", FLAGS_simlpe_share, 0.0, 1.0, &flags->options.simlpe_share);
  TakeInRange("blocks", FLAGS_blocks, 1, 1000, &simlpe.blocks);
}

const KindFlags<TrainGeneratorFlags> kSimlpeFlags(GeneratorKind::kSimlpe, {"blocks"},
                                                  ReadSimlpeFlags);

}  // namespace
}  // namespace pushid
