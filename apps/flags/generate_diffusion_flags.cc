// apps: flags of pushid-generate that say something to generators of diffusion alone.
#include <gflags/gflags.h>

#include "apps/flags/body_flags.h"
#include "apps/flags/command_line.h"
#include "apps/flags/generate_flags.h"
#include "apps/flags/kind_flags.h"

namespace {
const pushid::DiffusionGeneratorOptions kSampling;
}  // namespace

DEFINE_double(push_spread, kSampling.push_spread,
              "diffusion, --samples: spread of the logarithm of the push between sampled futures");

namespace pushid {
namespace {

void ReadDiffusionFlags(GenerateFlags* flags) {
  flags->changes.diffusion = DiffusionOptionsFromCommandLine();
  TakeInRange("push_spread", FLAGS_push_spread, 0.0, 3.0, &flags->changes.diffusion.push_spread);
}

std::vector<const char*> DiffusionNames() {
  std::vector<const char*> names = DiffusionFlagNames();
  names.push_back("push_spread");
  return names;
}

const KindFlags<GenerateFlags> kDiffusionFlags(GeneratorKind::kDiffusion, DiffusionNames(),
                                               ReadDiffusionFlags);

}  // namespace
}  // namespace pushid
