// apps: pushid-train-restoration by flag.
#include "apps/flags/train_restoration_flags.h"

#include <gflags/gflags.h>

#include "apps/flags/body_flags.h"
#include "apps/flags/command_line.h"
#include "apps/flags/futures_flags.h"
#include "datasets/files/names.h"
#include "ident/model/model_json.h"
#include "ident/parameters/option_names.h"

DEFINE_string(model, "", "model that pushid-fit --model_out wrote: the pendulum to fit");
namespace {
std::string KindHelp() {
  std::string kinds;
  for (const pushid::RestorationKindRow& row : pushid::kRestorationKinds) {
    if (!row.trained) continue;
    kinds += (kinds.empty() ? "" : ", ") + std::string(row.name) + " (" + row.what + ")";
  }
  return "kind of restoration: " + kinds;
}
const std::string kKind = KindHelp();
}  // namespace

DEFINE_string(kind, pushid::RowOf(pushid::RestorationTrainingOptions{}.kind).name, kKind.c_str());
DEFINE_string(coordinates, pushid::NameOf(pushid::RestorationTrainingOptions{}.coordinates),
              "cvae: joints relative to the rod's tip (tip), or to the hip at frame 0 (ldp)");
DEFINE_string(sees, pushid::NameOf(pushid::RestorationTrainingOptions{}.view),
              "input of the poses: the person's pendulum (pendulum), also those of the neighbours "
              "(neighbours, window only), or none, for comparison (pose: window uses the first "
              "pose and the push, cvae the previous pose)");
DEFINE_bool(halves, pushid::RestorationTrainingOptions{}.halves,
            "cvae: a network for the lower and one for the upper body (false: one for both)");
DEFINE_string(training, pushid::NameOf(pushid::RestorationTrainingOptions{}.training),
              "cvae: pushid's training (own), or as published: Adam at 1e-4 falling to 1e-7, sigma "
              "compared, the latent variable drawn, no predicted pendulums (published)");
DEFINE_string(out, "", "folder to write: restoration.json, weights.npy, curve.svg");
DEFINE_string(json_out, "", "--crossvalidate: write the scores here (JSON)");
DEFINE_bool(check, pushid::TrainRestorationFlags{}.check,
            "only check the flags: nothing is read, trained or written");
DEFINE_int32(crossvalidate, pushid::TrainRestorationFlags{}.crossvalidate,
             "number of folds: instead of writing a restoration, refit pendulum and restoration in "
             "every fold and score the held-out recordings; 0: off");
DEFINE_double(effort, pushid::RestorationTrainingOptions{}.effort,
              "factor on the number of training steps");
DEFINE_string(more_settings, "",
              "also train the bodies on the recorded pendulums of these settings (named as in "
              "--setting); they are neither fitted nor scored");
DEFINE_uint64(seed, pushid::RestorationTrainingOptions{}.seed,
              "seed of weights, batches, noise and folds");
DEFINE_int32(num_threads, pushid::RestorationTrainingOptions{}.num_threads,
             "threads of the training; only one repeats to the last bit");

namespace pushid {
namespace {

// Flags of one kind alone, which must be at their defaults with others.
struct FlagOfKind {
  const char* flag;
  const char* given;  // as the command line has it
  RestorationKind kind;
};
constexpr FlagOfKind kFlagsOfKinds[] = {
    {"halves", "--nohalves", RestorationKind::kCvae},
    {"training", "--training", RestorationKind::kCvae},
};

bool AtDefault(const char* flag) {
  return gflags::GetCommandLineFlagInfoOrDie(flag).current_value ==
         gflags::GetCommandLineFlagInfoOrDie(flag).default_value;
}

// What goes with which kind.
void CheckKind(RestorationKind kind, RestorationView view) {
  const RestorationKindRow& row = RowOf(kind);
  if (view == RestorationView::kNeighbours && !row.sees_neighbours) {
    throw Error{"--sees=neighbours needs --kind=window"};
  }
  for (const FlagOfKind& own : kFlagsOfKinds) {
    if (kind == own.kind || AtDefault(own.flag)) continue;
    throw Error{std::string(own.given) + " needs --kind=" + NameOf(own.kind)};
  }
  if (AtDefault("coordinates")) return;
  if (kind != RestorationKind::kCvae || view == RestorationView::kPose) {
    throw Error{
        "--coordinates needs --kind=cvae --sees=pendulum: without a pendulum there is no tip"};
  }
}

// What the command line says, but the model.
void ReadOptions(RestorationRunOptions* options) {
  Require("model", FLAGS_model, "give a file that pushid-fit --model_out wrote");
  const auto kind = FromName<RestorationKind>(FLAGS_kind);
  if (!kind || !RowOf(*kind).trained) {
    throw Error{"--kind is '" + FLAGS_kind + "'; it must be " + TrainedRestorationKinds()};
  }
  RestorationTrainingOptions& training = options->training;
  training.kind = *kind;
  OrFail(ParseName("--coordinates", FLAGS_coordinates, &training.coordinates));
  OrFail(ParseName("--sees", FLAGS_sees, &training.view));
  OrFail(ParseName("--training", FLAGS_training, &training.training));
  CheckKind(*kind, training.view);
  if (FLAGS_crossvalidate == 0) {
    Require("out", FLAGS_out, "name the folder to write");
  } else if (FLAGS_crossvalidate < 2) {
    throw Error{"--crossvalidate must be 0 or at least 2 folds"};
  }
  if (Given("forecast")) {
    throw Error{"--forecast: restorations are scored on both forecasters together; leave it out"};
  }
  options->observed = ObservedFrames();
  if (options->observed > 0 && FLAGS_crossvalidate == 0) {
    throw Error{"--observed needs --crossvalidate: training uses whole recordings"};
  }
  if (!(FLAGS_effort > 0.0 && FLAGS_effort <= 100.0)) {
    throw Error{"--effort must lie above 0 and not above 100"};
  }
  if (FLAGS_num_threads < 1) throw Error{"--num_threads must be positive"};
  training.halves = FLAGS_halves;
  training.effort = FLAGS_effort;
  training.seed = FLAGS_seed;
  training.num_threads = FLAGS_num_threads;
}

// The pendulum's options as the model has them.
void ReadModel(FitOptions* fit) {
  const FittedModel model = OrFail(ReadFittedModel(FLAGS_model));
  *fit = model.fit.options;
  fit->num_threads = FLAGS_num_threads;
}

}  // namespace

TrainRestorationFlags TrainRestorationFlagsFromCommandLine() {
  TrainRestorationFlags flags;
  ReadOptions(&flags.options);
  flags.options.postprocess = PostprocessFromCommandLine();
  flags.check = FLAGS_check;
  if (flags.check) return flags;
  ReadModel(&flags.options.fit);
  flags.scheme = SchemeFromCommandLine(FLAGS_crossvalidate > 0);
  OrFail(CheckOutputFiles({FLAGS_json_out}));
  flags.out = FLAGS_out;
  flags.crossvalidate = FLAGS_crossvalidate;
  flags.json_out = FLAGS_json_out;
  flags.more_settings = FLAGS_more_settings;
  return flags;
}

}  // namespace pushid
