// apps: pushid-check: questions put to a finished model, with the recordings that it was fitted to.
#include <cstring>

#include "apps/flags/command_line.h"
#include "apps/flags/recording_flags.h"
#include "ident/checks/model_checks.h"
#include "ident/model/model_json.h"
#include "ident/parameters/option_table.h"
#include "ident/parameters/presets.h"
#include "ident/report/advice.h"
#include "ident/report/page/build_report.h"
#include "ident/report/report_text.h"

DEFINE_string(model, "", "model that pushid-fit --model_out wrote; the checks are added to it");
DEFINE_string(model_out, "", "write the model with the checks here (JSON) instead of to --model");
DEFINE_string(seed, "", "seed of all random numbers (default: that of the fit)");
DEFINE_int32(num_threads, 1, "threads; results are the same for any number");
DEFINE_bool(details, false, "print the model's whole report too");

DEFINE_string(profile, "",
              "profile likelihood of these parameters and combinations, comma-separated; all (or "
              "--profile alone): every free parameter");
DEFINE_int32(bootstrap, 0,
             "number of refits to resampled people or recordings; 199 is usually enough");
DEFINE_string(bootstrap_by, pushid::NameOf(pushid::BootstrapOptions{}.by),
              "unit drawn by a bootstrap: subject (all recordings of a person), recording, or auto "
              "(as standard errors are clustered, but recordings where people share them)");
DEFINE_string(
    design, "",
    "find which further push, of whom and with a force sensor or without, would lower the "
    "standard error of this parameter most (all: of all parameters together)");

DEFINE_bool(
    horizon_check, false,
    "refit the first 8, 16, 32 and 64 frames: a parameter with physical meaning keeps its value");
DEFINE_bool(learn_forecasts, false,
            "learn what predictions from first frames (--observed of pushid-predict and "
            "pushid-evaluate) are put together by, on recordings left out in turn");

namespace {

using namespace pushid;

// fit: the options of the model, whose seed holds unless another is given.
ModelChecks ChecksFromCommandLine(FitOptions fit) {
  if (!FLAGS_seed.empty()) OrFail(FindFitOption("seed")->apply(FLAGS_seed, &fit));
  ModelChecks checks;
  checks.profile = FLAGS_profile;
  checks.bootstrap.replicas = FLAGS_bootstrap;
  checks.horizon_check = FLAGS_horizon_check;
  checks.learn_forecasts = FLAGS_learn_forecasts;
  checks.design = FLAGS_design;
  checks.bootstrap.seed = fit.seed;
  checks.bootstrap.num_threads = checks.num_threads = FLAGS_num_threads;
  OrFail(CheckNumbers(checks));
  OrFail(ParseName("--bootstrap_by", FLAGS_bootstrap_by, &checks.bootstrap.by));
  return checks;
}

// Adds these flags to the record of how the model was made.
void AddToProvenance(Provenance* from) {
  const std::map<std::string, std::string> now = EffectiveFlags();
  std::vector<std::string>& known = from->changed_flags;
  std::vector<std::string> added;
  for (const std::string& name : ChangedFlags()) {
    const std::vector<std::string>& checks = CheckFlagNames();
    const bool asks = std::find(checks.begin(), checks.end(), name) != checks.end();
    if (!asks && name != "bootstrap_by") continue;
    from->configuration[name] = now.at(name);
    if (std::find(known.begin(), known.end(), name) == known.end()) added.push_back(name);
  }
  known.insert(known.begin(), added.begin(), added.end());
}

int Run() {
  const double begin = Now();
  Require("model", FLAGS_model, "give a file that pushid-fit wrote");
  CheckRange("num_threads", FLAGS_num_threads, 1, 1024);
  CheckRecordingFlags();
  FittedModel model = OrFail(ReadFittedModel(FLAGS_model));
  const ModelChecks checks = ChecksFromCommandLine(model.fit.options);
  if (!checks.Any()) {
    return Fail(
        "nothing is asked; give one of --profile, --bootstrap=199, --horizon_check, "
        "--learn_forecasts or --design=all");
  }
  const std::string& out = FLAGS_model_out.empty() ? FLAGS_model : FLAGS_model_out;
  const bool writes = checks.Adds() || !FLAGS_model_out.empty();
  if (writes) OrFail(CheckWritable(out));
  LoadAs(model.provenance.configuration);
  const std::vector<Recording> loaded =
      LoadFittedRecordings(model.fit, NeedsJoints(model.fit.options.model));
  const std::vector<PendulumRecording> recordings =
      OrFail(AsFitted(MakePendulumRecordings(loaded), model.fit));
  OrFail(CheckAgainst(checks, model.fit.options, recordings));
  OrFail(ResumeFit(recordings, &model.fit));
  AddToProvenance(&model.provenance);
  model.provenance.model_file = out;
  ProgressLine line;
  OrFail(AddChecks(
      recordings, checks, [&line](const std::string& what) { return line.OfJobs(what); }, &model));
  line.Finish();
  const Screen found = OrFail(CheckScreen(recordings, checks, model));
  if (FLAGS_details) std::printf("%s", DetailsText(model).c_str());
  std::printf("%s", found.ToString().c_str());
  if (writes) OrFail(WriteFittedModel(out, model, FLAGS_num_threads, Now() - begin));
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  // gflags wants a value after --profile; alone it means all.
  static char all[] = "--profile=all";
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--profile") == 0 || std::strcmp(argv[i], "-profile") == 0) {
      argv[i] = all;
    }
  }
  return pushid::RunApp(argc, argv,
                        "pushid-check questions a fitted model: profiles, bootstrap, shorter "
                        "horizons, what to record next.\n"
                        "  pushid-check --model=model.json --recordings=recordings/manifest.json "
                        "--profile --bootstrap=99",
                        Run);
}
