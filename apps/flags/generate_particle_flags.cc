// apps: flags of pushid-generate that say something to generators of particles alone.
#include <gflags/gflags.h>

#include "apps/flags/command_line.h"
#include "apps/flags/generate_flags.h"
#include "apps/flags/kind_flags.h"

namespace {
const pushid::GeneratorChanges kAsTrained;
}  // namespace

DEFINE_double(ridge_share, -1.0, "share of the linear forecast in the blend; -1: as trained");
DEFINE_bool(project_bones, kAsTrained.particles.project_bones,
            "keep the bone lengths of the last observed frame");
DEFINE_double(noise_memory, kAsTrained.particles.noise_memory,
              "sampled futures: correlation of the noise between one frame and the next");
DEFINE_double(noise_scale, kAsTrained.particles.noise_scale,
              "sampled futures: factor on the learned noise");
DEFINE_bool(correlated_noise, kAsTrained.particles.correlated_noise,
            "sampled futures: noise is correlated across coordinates, like the errors of the "
            "drift; off: independent");
DEFINE_bool(
    mirror, kAsTrained.particles.mirror,
    "average with the forecast of the mirror image: like a second network, without training one");

namespace pushid {
namespace {

MaybeError ReadParticleFlags(GenerateFlags* flags) {
  ParticleGeneratorOptions& particles = flags->changes.particles;
  for (const MaybeError& error :
       {FLAGS_ridge_share == -1.0 ? MaybeError()
                                  : CheckRange("ridge_share", FLAGS_ridge_share, 0.0, 1.0),
        TakeInRange("noise_memory", FLAGS_noise_memory, 0.0, 0.99, &particles.noise_memory),
        TakeInRange("noise_scale", FLAGS_noise_scale, 0.01, 100.0, &particles.noise_scale)}) {
    if (error) return error;
  }
  if (FLAGS_ridge_share >= 0.0) flags->changes.ridge_share = FLAGS_ridge_share;
  particles.project_bones = FLAGS_project_bones;
  particles.correlated_noise = FLAGS_correlated_noise;
  particles.mirror = FLAGS_mirror;
  return std::nullopt;
}

const KindFlags<GenerateFlags> kParticleFlags(GeneratorKind::kParticles,
                                              {"ridge_share", "project_bones", "noise_memory",
                                               "noise_scale", "correlated_noise", "mirror"},
                                              ReadParticleFlags);

}  // namespace
}  // namespace pushid
