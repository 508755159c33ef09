// apps: profiles and bootstrap by flag.
#include "apps/flags/confidence_flags.h"

#include <gflags/gflags.h>

#include <cstring>
#include <sstream>

#include "apps/flags/command_line.h"
#include "apps/flags/fit_option_flags.h"
#include "apps/support/app_support.h"
#include "apps/support/interruption.h"
#include "datasets/files/atomic_file.h"
#include "datasets/files/number_text.h"
#include "ident/fit/confidence.h"
#include "ident/parameters/option_names.h"
#include "ident/push/push_check.h"
#include "ident/report/confidence_text.h"
#include "ident/report/design_text.h"

DEFINE_string(profile, "",
              "profile likelihood of these parameters and combinations, comma-separated; all (or "
              "--profile alone): every free parameter");
DEFINE_int32(bootstrap, 0,
             "number of refits to resampled people or recordings; 199 is usually enough");
DEFINE_string(bootstrap_by, NameOf(pushid::BootstrapOptions{}.by),
              "unit drawn by a bootstrap (and --resample): subject (all recordings of a person), "
              "recording, or auto (as --cluster, but recordings where people share them)");
DEFINE_string(bootstrap_file, "",
              "file that keeps finished replicas, so that an interrupted run can continue");
DEFINE_string(design, "",
              "find which further push would lower the standard error of this parameter most (all: "
              "of all parameters together), and how much a force sensor or more people would");

DEFINE_bool(population, false,
            "print how recordings differ from the mean: the spread of a factor on tail_gain, and "
            "each recording's effect");
DEFINE_bool(
    push_check, false,
    "refit with other plausible pushes: other windows and smoothing for inverse dynamics; sensor "
    "noise, a shift of one frame and of 0.1 m in contact height for measured pushes");
DEFINE_double(push_check_noise, pushid::PushVariantOptions{}.sensor_noise,
              "noise of the push sensor, as a fraction of the push's peak, for --push_check");
DEFINE_bool(prior_check, false, "refit with the means and widths of all priors halved and doubled");
DEFINE_bool(
    horizon_check, false,
    "refit the first 8, 16, 32 and 64 frames: a parameter with physical meaning keeps its value");

namespace pushid {
namespace {

std::vector<std::string> ProfileNames() {
  std::vector<std::string> names;
  if (FLAGS_profile == "all") return names;
  std::stringstream list(FLAGS_profile);
  for (std::string name; std::getline(list, name, ',');) names.push_back(name);
  return names;
}

JobProgress Show(ProgressLine* line, const std::string& what) {
  return [line, what](int done, int total) {
    line->Show(what + " " + std::to_string(done) + " of " + std::to_string(total));
  };
}

}  // namespace

void AllowBareProfile(int argc, char** argv) {
  static char all[] = "--profile=all";
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--profile") == 0 || std::strcmp(argv[i], "-profile") == 0) {
      argv[i] = all;
    }
  }
}

MaybeError CheckConfidenceFlags() {
  if (FLAGS_bootstrap < 0 || FLAGS_bootstrap == 1) {
    return Error{"--bootstrap must be 0 (none) or at least 2 replicas"};
  }
  if (!FLAGS_bootstrap_file.empty() && FLAGS_bootstrap == 0) {
    return Error{"--bootstrap_file needs --bootstrap=N"};
  }
  if (!(FLAGS_push_check_noise >= 0.0 && FLAGS_push_check_noise <= 1.0)) {
    return Error{"--push_check_noise is " + DoubleText(FLAGS_push_check_noise) +
                 "; it must be from 0 to 1, a fraction of the push's peak"};
  }
  if (Given("push_check_noise") && !FLAGS_push_check) {
    return Error{"--push_check_noise needs --push_check"};
  }
  ClusterBy by;
  if (MaybeError error = ParseName("--bootstrap_by", FLAGS_bootstrap_by, &by)) return error;
  return FLAGS_bootstrap_file.empty() ? std::nullopt : CheckWritable(FLAGS_bootstrap_file);
}

ClusterBy BootstrapBy() {
  ClusterBy by = BootstrapOptions{}.by;
  ParseName("--bootstrap_by", FLAGS_bootstrap_by, &by);  // CheckConfidenceFlags told of errors
  return by;
}

MaybeError CheckConfidence(const FitOptions& options, int recordings) {
  if (FLAGS_bootstrap > 0 && recordings < 2) {
    return Error{"--bootstrap draws people or recordings with replacement; it needs at least two"};
  }
  const bool stopped_early = options.early_stopping > 0.0 && !NeedsGradientTraining(options);
  if (stopped_early && (FLAGS_bootstrap > 0 || !FLAGS_profile.empty())) {
    return Error{
        "--profile and --bootstrap need the minimum of the cost, which a fit with --early_stopping "
        "does not reach; prevent overfitting with --network_prior instead"};
  }
  if (NeedsGradientTraining(options) &&
      (FLAGS_push_check || FLAGS_horizon_check || FLAGS_prior_check)) {
    return Error{
        "--push_check, --horizon_check and --prior_check refit many times, and this network is too "
        "large for that (trained by its gradient); choose a smaller one"};
  }
  if (options.likelihood != Likelihood::kTrajectory && FLAGS_horizon_check) {
    return Error{
        "--horizon_check compares rollouts of many lengths, including single steps; leave "
        "--likelihood out"};
  }
  if (FLAGS_population && options.model.push_tail == PushTail::kNone) {
    return Error{
        "--population estimates a factor on the push tail, and the model has none; add "
        "--push_tail=exponential (the presets tail and group have it)"};
  }
  if (FLAGS_design.empty() || FLAGS_design == "all") return std::nullopt;
  std::string known = "all";
  for (Parameter id : options.table.Free()) {
    known += ", " + options.table[id].name;
    if (options.table[id].name == FLAGS_design) return std::nullopt;
  }
  return Error{"--design: '" + FLAGS_design + "' has no standard error to reduce; choose from " +
               known};
}

MaybeError AddConfidence(const std::vector<PendulumRecording>& recordings, FittedModel* model) {
  ProgressLine line;
  if (!FLAGS_profile.empty()) {
    if (MaybeError error =
            AddProfiles(recordings, ProfileNames(), NumThreads(), Show(&line, "profile"), model)) {
      return Error{"--profile: " + error->ToString()};
    }
  }
  if (FLAGS_bootstrap > 0) {
    BootstrapOptions options;
    options.replicas = FLAGS_bootstrap;
    options.seed = Seed();
    options.file = FLAGS_bootstrap_file;
    options.num_threads = NumThreads();
    options.by = BootstrapBy();
    if (!options.file.empty()) {
      SayWhenInterrupted("finished replicas are in " + options.file +
                         "; run the same command to continue");
    }
    if (MaybeError error =
            AddBootstrap(recordings, options, Show(&line, "bootstrap replica"), model)) {
      return *error;
    }
  }
  if (FLAGS_push_check) {
    PushVariantOptions options;
    options.sensor_noise = FLAGS_push_check_noise;
    options.seed = Seed();
    if (MaybeError error =
            AddPushCheck(recordings, options, NumThreads(), Show(&line, "push"), model)) {
      return Error{"--push_check: " + error->ToString()};
    }
  }
  if (FLAGS_prior_check) AddPriorCheck(recordings, model);
  if (FLAGS_horizon_check) {
    AddHorizonCheck(recordings, NumThreads(), Show(&line, "horizon"), model);
  }
  return std::nullopt;
}

std::string FlaggedPopulation(const FitResult& result) {
  const bool asked = FLAGS_population && result.recording_effect;
  return asked ? "\n" + PopulationText(*result.recording_effect) : "";
}

Result<std::string> FlaggedDesign(const std::vector<PendulumRecording>& recordings,
                                  const FitResult& result) {
  if (FLAGS_design.empty()) return std::string();
  const ExperimentDesign design = DesignExperiments(recordings, result);
  const Result<std::string> text = DesignText(design, FLAGS_design);
  if (!text.ok()) return Error{"--design: " + text.error().message};
  return "\n" + text.value();
}

}  // namespace pushid
