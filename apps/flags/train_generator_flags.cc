// apps: pushid-train-generator by flag.
#include "apps/flags/train_generator_flags.h"

#include <gflags/gflags.h>

#include "apps/flags/body_flags.h"
#include "apps/flags/command_line.h"
#include "apps/flags/kind_flags.h"
#include "apps/flags/recording_flags.h"
#include "datasets/files/names.h"
#include "ident/model/model_json.h"
#include "ident/parameters/option_names.h"

namespace {
const pushid::TrainGeneratorFlags kFlags;
const pushid::GeneratorTrainingOptions kOptions;
const char* const kOfKind = "0: default of the kind";
std::string OfKind(const std::string& what) { return what + "; " + kOfKind; }
std::string KindHelp() {
  std::string kinds;
  for (const pushid::GeneratorKindRow& row : pushid::kGeneratorKinds) {
    kinds += (kinds.empty() ? "" : " or ") + std::string(row.name) + " (" + row.what + ")";
  }
  return "kind of generator: " + kinds;
}
const std::string kKind = KindHelp();
const std::string kObserved = OfKind(
    "pushes: number of observed frames (diffusion: in use and in scoring); 1: the first pose and "
    "the push");
const std::string kSeeds = OfKind("number of networks of different seeds that are averaged");
const std::string kSteps = OfKind("training steps (particles: of the drift) per seed");
const std::string kBatch = OfKind("batch size of a step: windows, or groups of people");
const std::string kRate = OfKind("peak learning rate, after the warm-up");
}  // namespace

DEFINE_string(kind, pushid::NameOf(kOptions.kind), kKind.c_str());
DEFINE_string(dataset, pushid::NameOf(kFlags.data),
              "training data: cmu (motion-capture clips in --folder) or pushes (--recordings; "
              "required by diffusion)");
DEFINE_string(
    accuracy, pushid::NameOf(kFlags.accuracy),
    "diffusion: best cross-validates it (four folds) against physics with restored "
    "bodies and against blends of both, and trains it and what else the most accurate needs, "
    "which pushid-generate uses (if interrupted, the comparison starts again); or usual");
DEFINE_string(folder, "", "cmu: the folder of clips, with skeleton.json and train/");
DEFINE_bool(with_validation, kFlags.with_validation,
            "cmu: also train on the validation clips, which then cannot validate");
DEFINE_int32(observed, 0, kObserved.c_str());
DEFINE_double(held_out, kFlags.held_out,
              "pushes: fraction of the recordings held out to monitor the training");
DEFINE_string(out, "", "folder to write: generator.json, weights.npy, curve.svg");
DEFINE_int32(crossvalidate, kFlags.crossvalidate,
             "pushes: number of folds: instead of writing a generator, train in every fold and "
             "score the held-out recordings; 0: off");
DEFINE_string(physics, "",
              "diffusion: model that pushid-fit --model_out wrote; its pendulum is refitted to the "
              "training recordings, for --blend and --accuracy=best");
DEFINE_double(
    blend, kFlags.changes.diffusion.blend,
    "diffusion, --crossvalidate: blend of the hip paths, from 0 (forecast) to 1 (pendulum)");
DEFINE_int32(samples, kFlags.samples,
             "diffusion, --crossvalidate: number of sampled futures per held-out recording, for "
             "how often it lies among them; 0: none");
DEFINE_double(push_spread, kFlags.changes.diffusion.push_spread,
              "diffusion, --samples: spread of the logarithm of the push between sampled futures");
DEFINE_string(json_out, "", "--crossvalidate: write the scores here (JSON)");
DEFINE_int32(seeds, 0, kSeeds.c_str());
DEFINE_int32(steps, 0, kSteps.c_str());
DEFINE_int32(batch, 0, kBatch.c_str());
DEFINE_double(learning_rate, 0.0, kRate.c_str());
DEFINE_bool(correction, kOptions.correction,
            "cmu: correct the error of the summed displacements over the whole forecast by a few "
            "low frequencies");
DEFINE_double(ridge_share, kOptions.ridge_share,
              "cmu: share of the linear forecast, which fades over the next frames; 0: none");
DEFINE_uint64(seed, kOptions.seed, "the first of --seeds, and the seed of the folds");
DEFINE_int32(num_threads, kOptions.num_threads,
             "threads of the training; only a single thread is bit-reproducible");

DECLARE_string(published);

namespace pushid {
namespace {

// The kind first.
// SDE: particles alone, f and g trained together by Eq. 6 as printed, Eq. 10-12, one GRU. The paper
// does not give the weights of its losses in a form that fits metres; these were chosen here.
const std::vector<PublishedFlags> kPublished = {
    {"sde", {{"kind", "particles"},     {"dataset", "cmu"},      {"seeds", "1"},
             {"cell", "gru"},           {"batch", "32"},         {"learning_rate", "0.001"},
             {"constant_rate", "true"}, {"poses", "false"},      {"skip", "false"},
             {"correction", "false"},   {"ridge_share", "0"},    {"simlpe_share", "0"},
             {"jitter", "0"},           {"mirrored_share", "0"}, {"even_frames", "true"},
             {"together", "true"},      {"noise_loss", "drawn"}, {"distance_weight", "0"},
             {"squared_weight", "10"},  {"bone_weight", "1"},    {"critic_weight", "0.001"}}},
    // SDM: Tanke et al., ICCV 2023.
    {"sdm",
     {{"kind", "diffusion"},
      {"steps", "1500"},
      {"batch", "8"},
      {"frame", "own"},
      {"pooling", "mean_all"},
      {"pooling_at", "bottleneck"},
      {"joint_weight", "0"},
      {"difference_weight", "0"},
      {"bystanders", "0"}}}};

bool Best() { return FLAGS_accuracy == pushid::NameOf(ForecastAccuracy::kBest); }

void ReadNumbers(TrainGeneratorFlags* flags) {
  GeneratorTrainingOptions& options = flags->options;
  CheckRange("seeds", FLAGS_seeds, 0, 20);
  TakeInRange("steps", FLAGS_steps, 0, 1e6, &flags->steps);
  TakeInRange("batch", FLAGS_batch, 0, 4096, &flags->batch);
  CheckRange("observed", FLAGS_observed, 0, 1000);
  TakeInRange("learning_rate", FLAGS_learning_rate, 0.0, 1.0, &flags->learning_rate);
  TakeInRange("blend", FLAGS_blend, 0.0, 1.0, &flags->changes.diffusion.blend);
  TakeInRange("samples", FLAGS_samples, 0, 10000, &flags->samples);
  TakeInRange("push_spread", FLAGS_push_spread, 0.0, 3.0, &flags->changes.diffusion.push_spread);
  TakeInRange("ridge_share", FLAGS_ridge_share, 0.0, 1.0, &options.ridge_share);
  TakeInRange("held_out", FLAGS_held_out, 0.0, 0.5, &flags->held_out);
  TakeInRange("num_threads", FLAGS_num_threads, 1, 1024, &options.num_threads);
}

void OfOtherKinds(GeneratorKind kind) {
  for (const auto& foreign : KindFlags<TrainGeneratorFlags>::ForeignTo(kind)) {
    if (!Given(foreign.flag)) continue;
    throw Error{std::string("--") + foreign.flag + " needs --kind=" + NameOf(foreign.of)};
  }
}

// Flags of the other data, or of another kind, would do nothing.
void CheckForeign(GeneratorKind kind, GeneratorData data) {
  const bool is_cmu = data == GeneratorData::kCmu, groups = RowOf(kind).groups;
  const auto refuse = [](std::initializer_list<const char*> flags, const std::string& goes_with) {
    for (const char* flag : flags) {
      if (Given(flag)) throw Error{std::string("--") + flag + " needs " + goes_with};
    }
  };
  if (is_cmu && groups) {
    throw Error{"--kind=" + NameOf(kind) + " trains on pushed groups; give --dataset=pushes"};
  }
  if (is_cmu) {
    refuse({"recordings", "setting", "observed", "held_out"}, "--dataset=pushes");
  } else {
    refuse(
        {"folder", "with_validation", "correction", "ridge_share", "simlpe_share", "simlpe_steps"},
        "--dataset=cmu");
  }
  OfOtherKinds(kind);
  if (!groups) {
    refuse({"physics", "blend", "samples", "accuracy"}, "--kind=" + KindsOfGroups());
  }
  if (FLAGS_crossvalidate == 0) refuse({"blend", "samples"}, "--crossvalidate");
  if (FLAGS_samples == 0) refuse({"push_spread"}, "--samples");
  if (Best() && FLAGS_crossvalidate > 0) {
    throw Error{"--accuracy=best makes its own folds; leave out --crossvalidate"};
  }
  if (FLAGS_blend > 0.0 && FLAGS_physics.empty()) {
    throw Error{"--blend needs --physics, the pendulum's model"};
  }
  if (FLAGS_blend == 0.0 && !Best() && !FLAGS_physics.empty()) {
    throw Error{"--physics is only used by --blend and --accuracy=best: give one of them"};
  }
}

void CheckData(GeneratorKind kind, GeneratorData data) {
  CheckForeign(kind, data);
  if (data == GeneratorData::kCmu) {
    if (FLAGS_crossvalidate != 0) {
      throw Error{
          "--crossvalidate makes folds of pushes; --dataset=cmu has a validation split, which "
          "pushid-generate scores"};
    }
    Require("folder", FLAGS_folder, "name the folder of the clips");
  } else {
    CheckRecordingFlags();
  }
  if (FLAGS_crossvalidate != 0 && FLAGS_crossvalidate < 2) {
    throw Error{"--crossvalidate must be 0 or at least 2 folds"};
  }
  if (FLAGS_crossvalidate == 0) Require("out", FLAGS_out, "name the folder to write");
}

}  // namespace

TrainGeneratorFlags TrainGeneratorFlagsFromCommandLine() {
  TakePublished(kPublished);
  TrainGeneratorFlags flags;
  GeneratorTrainingOptions& options = flags.options;
  OrFail(ParseName("--kind", FLAGS_kind, &options.kind));
  OrFail(ParseName("--dataset", FLAGS_dataset, &flags.data));
  OrFail(ParseName("--accuracy", FLAGS_accuracy, &flags.accuracy));
  ReadNumbers(&flags);
  KindFlags<TrainGeneratorFlags>::ReadAll(&flags);
  for (const PublishedFlags& paper : kPublished) {
    const std::string kind = paper.values.front().second;
    if (FLAGS_published == paper.paper && FLAGS_kind != kind) {
      throw Error{"--published=" + FLAGS_published + " needs --kind=" + kind};
    }
  }
  flags.scheme = SchemeFromCommandLine(FLAGS_crossvalidate > 0 || Best());
  const GeneratorKindRow& kind = RowOf(options.kind);
  if (!Given("dataset") && kind.groups) flags.data = GeneratorData::kPushes;
  CheckData(options.kind, flags.data);
  OrFail(CheckOutputFiles({FLAGS_json_out}));
  flags.folder = FLAGS_folder;
  flags.with_validation = FLAGS_with_validation;
  flags.observed = FLAGS_observed > 0 ? FLAGS_observed : kind.observed;
  flags.out = FLAGS_out;
  flags.crossvalidate = FLAGS_crossvalidate;
  flags.json_out = FLAGS_json_out;
  options.seeds = FLAGS_seeds > 0 ? FLAGS_seeds : kind.seeds;
  options.seed = FLAGS_seed;
  options.correction = FLAGS_correction;
  if (FLAGS_physics.empty()) return flags;
  const FittedModel physics = OrFail(ReadFittedModel(FLAGS_physics));
  flags.physics = physics.fit.options;
  flags.physics->num_threads = FLAGS_num_threads;
  return flags;
}

}  // namespace pushid
