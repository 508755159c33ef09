// apps: flags of pushid-train-generator that train generators of particles alone.
#include <gflags/gflags.h>

#include "apps/flags/command_line.h"
#include "apps/flags/kind_flags.h"
#include "apps/flags/train_generator_flags.h"

namespace {
const pushid::ParticleTrainingOptions kParticles;
}  // namespace

DEFINE_int32(noise_steps, kParticles.noise_steps,
             "training steps of the noise; 0: do not learn noise");
DEFINE_double(jitter, kParticles.jitter,
              "noise added to the input pose, in its standard deviations");
DEFINE_string(cell, pushid::NameOf(kParticles.structure.cell), "memory of the network: gru, lstm");
DEFINE_bool(
    skip, kParticles.structure.skip,
    "initialize the drift with the last displacement and add a linear function of the last nine");
DEFINE_bool(pose_operator, kParticles.structure.pose_operator,
            "predict displacements and sum them; off: predict the next pose itself");
DEFINE_bool(particles, kParticles.structure.particles,
            "displacements are an input besides the pose; off: poses only, as input and output");
DEFINE_double(squared_weight, kParticles.squared,
              "weight of squared distances (SDE's Eq. 10) in the loss");
DEFINE_double(bone_weight, kParticles.bones, "weight of bone lengths (SDE's Eq. 11) in the loss");
DEFINE_double(critic_weight, kParticles.critic,
              "weight of a Wasserstein critic (SDE's Eq. 12) in the loss");
DEFINE_string(
    noise_loss, pushid::NameOf(kParticles.noise_loss),
    "loss of the noise: likelihood, or squared (without the determinant; its noise vanishes)");

namespace pushid {
namespace {

MaybeError ReadParticleFlags(TrainGeneratorFlags* flags) {
  ParticleTrainingOptions& particles = flags->options.particles;
  for (const MaybeError& error :
       {ParseName("--cell", FLAGS_cell, &particles.structure.cell),
        ParseName("--noise_loss", FLAGS_noise_loss, &particles.noise_loss),
        TakeInRange("noise_steps", FLAGS_noise_steps, 0, 1e6, &particles.noise_steps),
        TakeInRange("jitter", FLAGS_jitter, 0.0, 100.0, &particles.jitter),
        TakeInRange("squared_weight", FLAGS_squared_weight, 0.0, 1e6, &particles.squared),
        TakeInRange("bone_weight", FLAGS_bone_weight, 0.0, 1e6, &particles.bones),
        TakeInRange("critic_weight", FLAGS_critic_weight, 0.0, 1e6, &particles.critic)}) {
    if (error) return error;
  }
  if (flags->steps > 0) particles.steps = flags->steps;
  if (flags->batch > 0) particles.batch = flags->batch;
  if (flags->learning_rate > 0.0) particles.learning_rate = flags->learning_rate;
  particles.structure.skip = FLAGS_skip;
  particles.structure.pose_operator = FLAGS_pose_operator;
  particles.structure.particles = FLAGS_particles;
  return std::nullopt;
}

const KindFlags<TrainGeneratorFlags> kParticleFlags(GeneratorKind::kParticles,
                                                    {"noise_steps", "jitter", "cell", "skip",
                                                     "pose_operator", "particles", "squared_weight",
                                                     "bone_weight", "critic_weight", "noise_loss"},
                                                    ReadParticleFlags);

}  // namespace
}  // namespace pushid
