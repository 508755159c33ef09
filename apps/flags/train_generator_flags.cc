// apps: pushid-train-generator by flag.
#include "apps/flags/train_generator_flags.h"

#include <gflags/gflags.h>

#include "apps/flags/body_flags.h"
#include "apps/flags/command_line.h"
#include "apps/flags/recording_flags.h"
#include "datasets/files/names.h"
#include "ident/model/model_json.h"
#include "ident/parameters/option_names.h"

namespace {
const pushid::TrainGeneratorFlags kFlags;
const pushid::GeneratorTrainingOptions kOptions;
std::string KindHelp() {
  std::string kinds;
  for (const pushid::GeneratorKindRow& row : pushid::kGeneratorKinds) {
    kinds += (kinds.empty() ? "" : " or ") + std::string(row.name) + " (" + row.what + ")";
  }
  return "kind of generator: " + kinds;
}
const std::string kKind = KindHelp();
}  // namespace

DEFINE_string(kind, pushid::NameOf(kOptions.kind), kKind.c_str());
DEFINE_string(folder, "",
              "particles: the folder of motion-capture clips, with skeleton.json and train/");
DEFINE_bool(
    hold_out, kFlags.hold_out,
    "show how the training goes on the validation clips, or on 15 % of the recordings, which "
    "are not learned from; off: learn from these too");
DEFINE_int32(
    observed, kFlags.observed,
    "diffusion: number of observed frames in use and in scoring; 1: the first poses and the "
    "push");
DEFINE_string(out, "", "folder to write: generator.json, weights.npy, curve.svg");
DEFINE_int32(crossvalidate, kFlags.crossvalidate,
             "diffusion: number of folds: instead of writing a generator, train in every fold and "
             "score the held-out recordings; 0: off");
DEFINE_string(physics, "",
              "diffusion: model that pushid-fit --model_out wrote; its pendulum is refitted to the "
              "training recordings, for --blend");
DEFINE_double(
    blend, kFlags.changes.diffusion.blend,
    "diffusion, --crossvalidate: blend of the hip paths, from 0 (forecast) to 1 (pendulum)");
DEFINE_string(json_out, "", "--crossvalidate: write the scores here (JSON)");
DEFINE_int32(seeds, 0,
             "number of networks of different seeds that are averaged; 0: default of the kind");
DEFINE_int32(steps, 0, "training steps (particles: of the drift) per seed; 0: default of the kind");
DEFINE_int32(batch, 0,
             "batch size of a step: windows, or groups of people; 0: default of the kind");
DEFINE_int32(noise_steps, kOptions.particles.noise_steps,
             "particles: training steps of the noise; 0: do not learn noise");
DEFINE_int32(simlpe_steps, kOptions.simlpe.steps,
             "particles: training steps of the siMLPe that is blended with");
DEFINE_string(pooling, pushid::NameOf(kOptions.diffusion.structure.pooling),
              "diffusion: interaction between people: local (by distance, ahead and behind), none; "
              "mean_all (the default of --published=sdm) and heads (attention) as in SDM");
DEFINE_string(
    without, "",
    "--published=sde: what of it is left out, comma-separated: particles (poses alone go "
    "in and come out), noise (and Eq. 6), draw (Eq. 6 with its determinant instead), bones "
    "(Eq. 11), critic (Eq. 12)");
DEFINE_uint64(seed, kOptions.seed, "the first of --seeds, and the seed of the folds");
DEFINE_int32(num_threads, kOptions.num_threads,
             "threads of the training; only a single thread is bit-reproducible");

namespace pushid {
namespace {

// Lyu et al., ACM MM 2021: particles alone, f and g trained together by Eq. 6 as printed, Eq.
// 10-12, one GRU. The paper does not give the weights of its losses in a form that fits metres;
// these were chosen here.
void SetSde(GeneratorTrainingOptions* options) {
  options->seeds = 1;
  options->correction = false;
  options->ridge_share = options->simlpe_share = 0.0;
  ParticleTrainingOptions& sde = options->particles;
  sde.batch = 32;
  sde.constant_rate = sde.even_frames = sde.together = true;
  sde.structure.poses = sde.structure.skip = sde.structure.correlated_noise = false;
  sde.jitter = sde.mirrored = sde.distance = 0.0;
  sde.noise_loss = NoiseLoss::kDrawn;
  sde.squared = 10.0;
  sde.bones = 1.0;
  sde.critic = 0.001;
  for (const std::string& part : SplitList(FLAGS_without)) {
    if (part == "particles") {
      sde.structure.particles = false;
      sde.structure.poses = true;
    } else if (part == "noise") {
      sde.together = false;
      sde.noise_steps = 0;
      sde.structure.correlated_noise = true;
    } else if (part == "draw") {
      sde.noise_loss = NoiseLoss::kLikelihood;
    } else if (part == "bones") {
      sde.bones = 0.0;
    } else if (part == "critic") {
      sde.critic = 0.0;
    } else {
      throw Error{"--without names '" + part +
                  "'; it must list particles, noise, draw, bones or critic"};
    }
  }
}

// Tanke et al., ICCV 2023.
void SetSdm(DiffusionTrainingOptions* sdm) {
  sdm->steps = 1500;
  sdm->groups = 8;
  sdm->structure = {SocialPooling::kMeanAll, SocialJoin::kBottleneck, MotionFrame::kOwn};
  sdm->joint_weight = sdm->difference_weight = sdm->bystanders = 0.0;
  sdm->turn = sdm->size = 0.0;  // own frames are turned and scaled already
}

void ReadPublished(GeneratorTrainingOptions* options) {
  const std::string paper = PublishedFromCommandLine();
  if (paper != "sde" && Given("without")) throw Error{"--without needs --published=sde"};
  if (paper.empty()) return;
  const GeneratorKind kind = paper == "sde" ? GeneratorKind::kParticles : GeneratorKind::kDiffusion;
  if (Given("kind") && options->kind != kind) {
    throw Error{"--published=" + paper + " needs --kind=" + NameOf(kind)};
  }
  options->kind = kind;
  if (paper == "sde") {
    SetSde(options);
  } else {
    SetSdm(&options->diffusion);
  }
}

void ReadNumbers(TrainGeneratorFlags* flags) {
  GeneratorTrainingOptions& options = flags->options;
  CheckRange("seeds", FLAGS_seeds, 0, 20);
  CheckRange("steps", FLAGS_steps, 0, 1e6);
  CheckRange("batch", FLAGS_batch, 0, 4096);
  TakeInRange("observed", FLAGS_observed, 1, 1000, &flags->observed);
  TakeInRange("blend", FLAGS_blend, 0.0, 1.0, &flags->changes.diffusion.blend);
  TakeInRange("num_threads", FLAGS_num_threads, 1, 1024, &options.num_threads);
  TakeInRange("simlpe_steps", FLAGS_simlpe_steps, 1, 1e6, &options.simlpe.steps);
  CheckRange("noise_steps", FLAGS_noise_steps, 0, 1e6);
  if (Given("noise_steps")) {
    if (options.particles.together) {
      throw Error{"--published=sde trains the noise with the drift; leave out --noise_steps"};
    }
    options.particles.noise_steps = FLAGS_noise_steps;
  }
  if (FLAGS_seeds > 0) options.seeds = FLAGS_seeds;
  if (FLAGS_steps > 0) options.particles.steps = options.diffusion.steps = FLAGS_steps;
  if (FLAGS_batch > 0) {
    options.particles.batch = options.simlpe.batch = options.diffusion.groups = FLAGS_batch;
  }
  if (Given("pooling")) {
    OrFail(ParseName("--pooling", FLAGS_pooling, &options.diffusion.structure.pooling));
  }
}

// Flags of another kind would do nothing.
void CheckKind(const GeneratorKindRow& kind) {
  const auto refuse = [](std::initializer_list<const char*> flags, const std::string& goes_with) {
    for (const char* flag : flags) {
      if (Given(flag)) throw Error{std::string("--") + flag + " needs " + goes_with};
    }
  };
  if (kind.groups) {
    refuse({"folder", "noise_steps", "simlpe_steps"},
           "--kind=" + NameOf(GeneratorKind::kParticles));
  } else {
    refuse({"recordings", "setting", "observed", "crossvalidate", "physics", "blend", "pooling"},
           "--kind=" + KindsOfGroups());
    Require("folder", FLAGS_folder, "name the folder of the clips");
  }
  if (FLAGS_crossvalidate == 0) refuse({"blend", "physics"}, "--crossvalidate");
  if (FLAGS_blend > 0.0 && FLAGS_physics.empty()) {
    throw Error{"--blend needs --physics, the pendulum's model"};
  }
  if (FLAGS_blend == 0.0 && !FLAGS_physics.empty()) {
    throw Error{"--physics does nothing without --blend; give --blend=0.5"};
  }
  if (kind.groups) CheckRecordingFlags();
  if (FLAGS_crossvalidate != 0 && FLAGS_crossvalidate < 2) {
    throw Error{"--crossvalidate must be 0 or at least 2 folds"};
  }
  if (FLAGS_crossvalidate == 0) Require("out", FLAGS_out, "name the folder to write");
}

}  // namespace

TrainGeneratorFlags TrainGeneratorFlagsFromCommandLine() {
  TrainGeneratorFlags flags;
  GeneratorTrainingOptions& options = flags.options;
  OrFail(ParseName("--kind", FLAGS_kind, &options.kind));
  options.seeds = RowOf(options.kind).seeds;
  ReadPublished(&options);
  ReadNumbers(&flags);
  flags.scheme = SchemeFromCommandLine(FLAGS_crossvalidate > 0);
  CheckKind(RowOf(options.kind));
  OrFail(CheckOutputFiles({FLAGS_json_out}));
  flags.folder = FLAGS_folder;
  flags.hold_out = FLAGS_hold_out;
  flags.out = FLAGS_out;
  flags.crossvalidate = FLAGS_crossvalidate;
  flags.json_out = FLAGS_json_out;
  options.seed = FLAGS_seed;
  if (FLAGS_physics.empty()) return flags;
  const FittedModel physics = OrFail(ReadFittedModel(FLAGS_physics));
  flags.physics = physics.fit.options;
  flags.physics->num_threads = FLAGS_num_threads;
  return flags;
}

}  // namespace pushid
