// apps: checks of a model by flag.
#include <gflags/gflags.h>

#include <cstring>

#include "apps/flags/fit_option_flags.h"
#include "apps/support/app_support.h"
#include "apps/support/overwrite_check.h"
#include "datasets/files/names.h"
#include "ident/report/fit_command.h"

DEFINE_string(profile, "",
              "profile likelihood of these parameters and combinations, comma-separated; all (or "
              "--profile alone): every free parameter");
DEFINE_int32(bootstrap, 0,
             "number of refits to resampled people or recordings; 199 is usually enough");
DEFINE_choice(bootstrap_by, pushid::BootstrapOptions{}.by,
              "unit drawn by a bootstrap (and by pushid-fit --replica): subject (all recordings "
              "of a person), recording, or auto (as --cluster of the fit, but recordings where "
              "people share them)");
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
DEFINE_bool(learn_forecasts, false,
            "learn what predictions from first frames (--observed of pushid-predict and "
            "pushid-evaluate) are put together by, on recordings left out in turn");

namespace pushid {

void AllowBareProfile(int argc, char** argv) {
  static char all[] = "--profile=all";
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--profile") == 0 || std::strcmp(argv[i], "-profile") == 0) {
      argv[i] = all;
    }
  }
}

ModelChecks ModelChecksFromCommandLine(uint64_t seed, int num_threads) {
  ModelChecks checks;
  checks.profile = FLAGS_profile;
  checks.bootstrap.replicas = FLAGS_bootstrap;
  checks.bootstrap.file = FLAGS_bootstrap_file;
  checks.push_check = FLAGS_push_check;
  checks.prior_check = FLAGS_prior_check;
  checks.horizon_check = FLAGS_horizon_check;
  checks.learn_forecasts = FLAGS_learn_forecasts;
  checks.pushes.sensor_noise = FLAGS_push_check_noise;
  checks.population = FLAGS_population;
  checks.design = FLAGS_design;
  checks.bootstrap.seed = checks.pushes.seed = seed;
  checks.bootstrap.num_threads = checks.num_threads = num_threads;
  OrFail(CheckNumbers(checks));
  CheckFlagRules({{"bootstrap_file", FlagRule::kNeeds, {"bootstrap"}, "=N"},
                  {"push_check_noise", FlagRule::kNeeds, {"push_check"}, ""}});
  OrFail(ParseName("--bootstrap_by", FLAGS_bootstrap_by, &checks.bootstrap.by));
  OrFail(CheckOutputFiles({FLAGS_bootstrap_file}));
  return checks;
}

MovedFlags MovedCheckFlags() {
  return {CheckFlagNames(), "pushid-check", "checks of a finished model"};
}

void AddFlaggedChecks(const std::vector<PendulumRecording>& recordings, const ModelChecks& checks,
                      FittedModel* model) {
  if (!checks.bootstrap.file.empty()) {
    SayWhenInterrupted("finished replicas are in " + checks.bootstrap.file +
                       "; run the same command to continue");
  }
  ProgressLine line;
  const auto progress = [&line](const std::string& what) { return line.OfJobs(what); };
  OrFail(AddChecks(recordings, checks, progress, model));
}

}  // namespace pushid
