// apps: flags of pushid-train-generator that train siMLPe alone.
#include <gflags/gflags.h>

#include "apps/flags/command_line.h"
#include "apps/flags/kind_flags.h"
#include "apps/flags/train_generator_flags.h"

namespace {
const pushid::SimlpeTrainingOptions kSimlpe;
}  // namespace

DEFINE_int32(blocks, kSimlpe.blocks, "simlpe: number of blocks; the paper has 48");

namespace pushid {
namespace {

MaybeError ReadSimlpeFlags(TrainGeneratorFlags* flags) {
  SimlpeTrainingOptions& simlpe = flags->options.simlpe;
  if (flags->steps > 0) simlpe.steps = flags->steps;
  if (flags->batch > 0) simlpe.batch = flags->batch;
  if (flags->learning_rate > 0.0) simlpe.learning_rate = flags->learning_rate;
  return TakeInRange("blocks", FLAGS_blocks, 1, 1000, &simlpe.blocks);
}

const KindFlags<TrainGeneratorFlags> kSimlpeFlags(GeneratorKind::kSimlpe, {"blocks"},
                                                  ReadSimlpeFlags);

}  // namespace
}  // namespace pushid
