// apps: flags of pushid-generate that say something to generators of particles alone.
#include <gflags/gflags.h>

#include "apps/flags/command_line.h"
#include "apps/flags/generate_flags.h"
#include "apps/flags/kind_flags.h"

namespace {
const pushid::GeneratorChanges kAsTrained;
}  // namespace

DEFINE_double(ridge_share, -1.0,
              "share of the linear forecast, which fades over the next frames; -1: as trained");
DEFINE_double(simlpe_share, -1.0,
              "share of siMLPe, which it comes to in the far future; -1: as trained");
DEFINE_bool(project_bones, kAsTrained.particles.project_bones,
            "keep the bone lengths of the last observed frame");
DEFINE_double(noise_memory, kAsTrained.particles.noise_memory,
              "sampled futures: correlation of the noise between one frame and the next");
DEFINE_bool(correlated_noise, kAsTrained.particles.correlated_noise,
            "sampled futures: noise is correlated across coordinates, like the errors of the "
            "drift; off: independent");

namespace pushid {
namespace {

void ReadParticleFlags(GenerateFlags* flags) {
  ParticleGeneratorOptions& particles = flags->changes.particles;
  const auto take = [](const char* flag, double share, std::optional<double>* into) {
    if (share == -1.0) return;
    *into = share;
    CheckRange(flag, share, 0.0, 1.0);
  };
  take("ridge_share", FLAGS_ridge_share, &flags->changes.ridge_share);
  take("simlpe_share", FLAGS_simlpe_share, &flags->changes.simlpe_share);
  TakeInRange("noise_memory", FLAGS_noise_memory, 0.0, 0.99, &particles.noise_memory);
  particles.project_bones = FLAGS_project_bones;
  particles.correlated_noise = FLAGS_correlated_noise;
}

const KindFlags<GenerateFlags> kParticleFlags(GeneratorKind::kParticles,
                                              {"ridge_share", "simlpe_share", "project_bones",
                                               "noise_memory", "correlated_noise"},
                                              ReadParticleFlags);

}  // namespace
}  // namespace pushid
