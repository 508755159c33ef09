// apps: sampling of diffusion by flag.
#include <gflags/gflags.h>

#include "apps/flags/body_flags.h"
#include "apps/flags/command_line.h"
#include "datasets/files/names.h"
#include "ident/parameters/option_names.h"

namespace {
const pushid::DiffusionGeneratorOptions kOptions;
}  // namespace

DEFINE_int32(averaged, kOptions.averaged, "diffusion: number of samples averaged into a forecast");
DEFINE_bool(mirrored_samples, kOptions.mirrored,
            "diffusion: every other of these samples is of the group in the mirror");
DEFINE_string(sampler, pushid::NameOf(kOptions.sampler),
              "diffusion: sampler: renoised, ddpm or ddim");
DEFINE_int32(sampling_steps, kOptions.steps, "diffusion: number of sampling steps");
DEFINE_string(settle, pushid::NameOf(kOptions.settle),
              "diffusion: what follows the longest motion learned from: fade (people come to rest) "
              "or none (the network alone, as in SDM)");
DEFINE_double(blend, kOptions.blend,
              "diffusion: blend of the hip paths, from 0 (forecast) to 1 (physics)");

namespace pushid {

DiffusionGeneratorOptions DiffusionOptionsFromCommandLine() {
  DiffusionGeneratorOptions options;
  OrFail(ParseName("--sampler", FLAGS_sampler, &options.sampler));
  OrFail(ParseName("--settle", FLAGS_settle, &options.settle));
  CheckRange("averaged", FLAGS_averaged, 1, 1000);
  CheckRange("sampling_steps", FLAGS_sampling_steps, 1, kDiffusionTime);
  CheckRange("blend", FLAGS_blend, 0.0, 1.0);
  options.averaged = FLAGS_averaged;
  options.mirrored = FLAGS_mirrored_samples;
  options.steps = FLAGS_sampling_steps;
  options.blend = FLAGS_blend;
  return options;
}

std::vector<const char*> DiffusionFlagNames() {
  return {"averaged", "mirrored_samples", "sampler", "sampling_steps", "settle", "blend"};
}

}  // namespace pushid
