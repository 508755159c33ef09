// apps: pushid-train-generator by flag.
#include "apps/flags/train_generator_flags.h"

#include <gflags/gflags.h>

#include "apps/flags/command_line.h"
#include "apps/flags/recording_flags.h"
#include "ident/parameters/option_names.h"

namespace {
const pushid::TrainGeneratorFlags kFlags;
const pushid::GeneratorTrainingOptions kOptions;
const pushid::ParticleTrainingOptions kParticles;
}  // namespace

DEFINE_string(kind, pushid::NameOf(kOptions.kind),
              "what is trained: particles (displacements that follow learned drift and noise)");
DEFINE_string(
    dataset, pushid::NameOf(kFlags.data),
    "what it learns from: cmu (motion-capture clips in --folder) or pushes (--recordings)");
DEFINE_string(folder, "", "cmu: the folder of clips, with skeleton.json and train/");
DEFINE_bool(with_validation, kFlags.with_validation,
            "cmu: learn from the validation clips too, which then judge nothing");
DEFINE_int32(observed, kFlags.observed,
             "pushes: frames that the generator is shown; 1: the first pose, and the push");
DEFINE_double(held_out, kFlags.held_out,
              "pushes: share of the recordings that only show how the training goes");
DEFINE_string(out, "", "folder to write: generator.json, weights.npy, curve.svg");
DEFINE_int32(crossvalidate, kFlags.crossvalidate,
             "pushes: folds; instead of writing a generator, train in every fold and score the "
             "recordings held out; 0: off");
DEFINE_string(json_out, "", "--crossvalidate: write the scores here (JSON)");
DEFINE_int32(seeds, kOptions.seeds, "networks of different seeds that are averaged");
DEFINE_int32(steps, kParticles.steps, "training steps of the drift, for every seed");
DEFINE_int32(noise_steps, kParticles.noise_steps,
             "training steps of the noise; 0: no noise learned");
DEFINE_int32(batch, kParticles.batch, "windows of a step");
DEFINE_double(learning_rate, kParticles.learning_rate, "the largest, after the warm-up");
DEFINE_double(jitter, kParticles.jitter, "of the pose that goes in, in its standard deviations");
DEFINE_string(cell, pushid::NameOf(kParticles.structure.cell), "memory of the network: gru, lstm");
DEFINE_bool(skip, kParticles.structure.skip,
            "the drift begins as the last displacement, and adds "
            "a linear function of the last nine");
DEFINE_bool(pose_operator, kParticles.structure.pose_operator,
            "displacements are predicted and summed up; off: the next pose itself is predicted");
DEFINE_bool(particles, kParticles.structure.particles,
            "displacements go in beside the pose; off: poses alone, in and out");
DEFINE_double(squared_weight, kParticles.squared,
              "weight of squared distances (SDE's Eq. 10) in the loss");
DEFINE_double(bone_weight, kParticles.bones, "weight of bone lengths (SDE's Eq. 11) in the loss");
DEFINE_double(critic_weight, kParticles.critic,
              "weight of a Wasserstein critic (SDE's Eq. 12) in the loss");
DEFINE_string(noise_loss, pushid::NameOf(kParticles.noise_loss),
              "how noise is learned: likelihood, or squared (without the determinant, whose noise "
              "goes to nothing)");
DEFINE_double(ridge_share, kOptions.ridge_share,
              "cmu: of the linear forecast in the blend; 0: none");
DEFINE_double(ridge_penalty, kOptions.ridge_penalty, "cmu: of the linear forecast, m^2");
DEFINE_double(checkpoint_seconds, kOptions.checkpoint_seconds,
              "time between two checkpoints in --out");
DEFINE_uint64(seed, kParticles.seed, "the first of --seeds, and that of folds");
DEFINE_int32(num_threads, kParticles.num_threads,
             "threads of the training; only one repeats to the last bit");

namespace pushid {
namespace {

MaybeError CheckRanges() {
  for (const MaybeError& error :
       {CheckRange("seeds", FLAGS_seeds, 1, 20), CheckRange("steps", FLAGS_steps, 1, 1e6),
        CheckRange("noise_steps", FLAGS_noise_steps, 0, 1e6),
        CheckRange("batch", FLAGS_batch, 1, 4096), CheckRange("observed", FLAGS_observed, 1, 1000),
        CheckRange("learning_rate", FLAGS_learning_rate, 1e-8, 1.0),
        CheckRange("jitter", FLAGS_jitter, 0.0, 100.0),
        CheckRange("squared_weight", FLAGS_squared_weight, 0.0, 1e6),
        CheckRange("bone_weight", FLAGS_bone_weight, 0.0, 1e6),
        CheckRange("critic_weight", FLAGS_critic_weight, 0.0, 1e6),
        CheckRange("ridge_share", FLAGS_ridge_share, 0.0, 1.0),
        CheckRange("ridge_penalty", FLAGS_ridge_penalty, 1e-12, 1e12),
        CheckRange("held_out", FLAGS_held_out, 0.0, 0.5),
        CheckRange("checkpoint_seconds", FLAGS_checkpoint_seconds, 0.0, 1e9),
        CheckRange("num_threads", FLAGS_num_threads, 1, 1024)}) {
    if (error) return error;
  }
  return std::nullopt;
}

// Flags of the other data would do nothing.
MaybeError CheckForeign(GeneratorData data) {
  const bool is_cmu = data == GeneratorData::kCmu;
  for (const char* flag : {"recordings", "setting", "observed", "held_out"}) {
    if (is_cmu && Given(flag))
      return Error{std::string("--") + flag + " goes with --dataset=pushes"};
  }
  for (const char* flag : {"folder", "with_validation", "ridge_share", "ridge_penalty"}) {
    if (!is_cmu && Given(flag)) return Error{std::string("--") + flag + " goes with --dataset=cmu"};
  }
  return std::nullopt;
}

MaybeError CheckData(GeneratorData data) {
  if (MaybeError error = CheckForeign(data)) return error;
  if (data == GeneratorData::kCmu) {
    if (FLAGS_crossvalidate != 0) {
      return Error{
          "--crossvalidate takes folds of pushes; --dataset=cmu has a validation split, "
          "by which pushid-generate judges"};
    }
    if (MaybeError missing = Require("folder", FLAGS_folder, "name the folder of the clips")) {
      return missing;
    }
  } else if (MaybeError error = CheckRecordingFlags()) {
    return error;
  }
  if (FLAGS_crossvalidate != 0 && FLAGS_crossvalidate < 2) {
    return Error{"--crossvalidate must be 0 or at least 2 folds"};
  }
  if (FLAGS_crossvalidate == 0) return Require("out", FLAGS_out, "name the folder to write");
  return std::nullopt;
}

}  // namespace

Result<TrainGeneratorFlags> TrainGeneratorFlagsFromCommandLine() {
  TrainGeneratorFlags flags;
  ParticleTrainingOptions& particles = flags.options.particles;
  for (const MaybeError& error :
       {ParseName("--kind", FLAGS_kind, &flags.options.kind),
        ParseName("--dataset", FLAGS_dataset, &flags.data),
        ParseName("--cell", FLAGS_cell, &particles.structure.cell),
        ParseName("--noise_loss", FLAGS_noise_loss, &particles.noise_loss), CheckRanges()}) {
    if (error) return *error;
  }
  if (MaybeError error = CheckData(flags.data)) return *error;
  if (MaybeError error = CheckOutputFiles({FLAGS_json_out})) return *error;
  flags.folder = FLAGS_folder;
  flags.with_validation = FLAGS_with_validation;
  flags.observed = FLAGS_observed;
  flags.held_out = FLAGS_held_out;
  flags.out = FLAGS_out;
  flags.crossvalidate = FLAGS_crossvalidate;
  flags.json_out = FLAGS_json_out;
  flags.options.seeds = FLAGS_seeds;
  flags.options.ridge_share = FLAGS_ridge_share;
  flags.options.ridge_penalty = FLAGS_ridge_penalty;
  flags.options.checkpoint_seconds = FLAGS_checkpoint_seconds;
  particles.structure.skip = FLAGS_skip;
  particles.structure.pose_operator = FLAGS_pose_operator;
  particles.structure.particles = FLAGS_particles;
  particles.steps = FLAGS_steps;
  particles.noise_steps = FLAGS_noise_steps;
  particles.batch = FLAGS_batch;
  particles.learning_rate = FLAGS_learning_rate;
  particles.jitter = FLAGS_jitter;
  particles.squared = FLAGS_squared_weight;
  particles.bones = FLAGS_bone_weight;
  particles.critic = FLAGS_critic_weight;
  particles.seed = FLAGS_seed;
  particles.num_threads = FLAGS_num_threads;
  return flags;
}

}  // namespace pushid
