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
DEFINE_bool(poses, kParticles.structure.poses,
            "poses are an input besides displacements; off: displacements only, as in SDE");
DEFINE_bool(together, kParticles.together,
            "train drift and noise together by SDE's Eq. 6 on the observed displacements, and the "
            "other losses on sampled paths (Eq. 2); off: the drift first, then the noise alone");
DEFINE_bool(constant_rate, kParticles.constant_rate,
            "keep the learning rate; off: a warm-up, then down to nothing by a cosine");
DEFINE_double(mirrored_share, kParticles.mirrored, "share of windows trained on in the mirror");
DEFINE_bool(even_frames, kParticles.even_frames,
            "all forecast frames have the same weight in the loss (always with pushes); off: frame "
            "t has 1/t");
DEFINE_double(distance_weight, kParticles.distance, "weight of distances in the loss");
DEFINE_double(squared_weight, kParticles.squared,
              "weight of squared distances (SDE's Eq. 10) in the loss");
DEFINE_double(bone_weight, kParticles.bones, "weight of bone lengths (SDE's Eq. 11) in the loss");
DEFINE_double(critic_weight, kParticles.critic,
              "weight of a Wasserstein critic (SDE's Eq. 12) in the loss");
DEFINE_string(
    noise_loss, pushid::NameOf(kParticles.noise_loss),
    "loss of transitions: likelihood; drawn (SDE's Eq. 6 as printed, with its noise drawn); or "
    "squared (the mean of drawn); the noise of the last two vanishes");

namespace pushid {
namespace {

void ReadParticleFlags(TrainGeneratorFlags* flags) {
  ParticleTrainingOptions& particles = flags->options.particles;
  OrFail(ParseName("--cell", FLAGS_cell, &particles.structure.cell));
  OrFail(ParseName("--noise_loss", FLAGS_noise_loss, &particles.noise_loss));
  TakeInRange("noise_steps", FLAGS_noise_steps, 0, 1e6, &particles.noise_steps);
  TakeInRange("jitter", FLAGS_jitter, 0.0, 100.0, &particles.jitter);
  TakeInRange("mirrored_share", FLAGS_mirrored_share, 0.0, 1.0, &particles.mirrored);
  TakeInRange("distance_weight", FLAGS_distance_weight, 0.0, 1e6, &particles.distance);
  TakeInRange("squared_weight", FLAGS_squared_weight, 0.0, 1e6, &particles.squared);
  TakeInRange("bone_weight", FLAGS_bone_weight, 0.0, 1e6, &particles.bones);
  TakeInRange("critic_weight", FLAGS_critic_weight, 0.0, 1e6, &particles.critic);
  if (flags->steps > 0) particles.steps = flags->steps;
  if (flags->batch > 0) particles.batch = flags->batch;
  if (flags->learning_rate > 0.0) particles.learning_rate = flags->learning_rate;
  particles.structure.skip = FLAGS_skip;
  particles.structure.pose_operator = FLAGS_pose_operator;
  particles.structure.particles = FLAGS_particles;
  particles.structure.poses = FLAGS_poses;
  particles.together = FLAGS_together;
  particles.structure.correlated_noise = !FLAGS_together;
  particles.constant_rate = FLAGS_constant_rate;
  particles.even_frames = FLAGS_even_frames;
  if (!FLAGS_poses && !FLAGS_particles) {
    throw Error{"--poses=false leaves displacements alone, and --particles=false poses; give one"};
  }
  if (FLAGS_together && Given("noise_steps")) {
    throw Error{"--together trains the noise with the drift; leave out --noise_steps"};
  }
}

const KindFlags<TrainGeneratorFlags> kParticleFlags(
    GeneratorKind::kParticles,
    {"noise_steps", "jitter",          "cell",           "skip",          "pose_operator",
     "particles",   "poses",           "together",       "constant_rate", "mirrored_share",
     "even_frames", "distance_weight", "squared_weight", "bone_weight",   "critic_weight",
     "noise_loss",  "correction",      "ridge_share",    "simlpe_share",  "simlpe_steps"},
    ReadParticleFlags);

}  // namespace
}  // namespace pushid
