// apps: pushid-check: questions put to a finished model, with the recordings that it was fitted to.
#include <gflags/gflags.h>

#include <algorithm>
#include <cstdio>

#include "apps/flags/command_line.h"
#include "apps/flags/fit_option_flags.h"
#include "apps/flags/recording_flags.h"
#include "datasets/files/atomic_file.h"
#include "ident/bodies/restoration_files.h"
#include "ident/model/model_json.h"
#include "ident/parameters/option_table.h"
#include "ident/parameters/presets.h"
#include "ident/problem/parallel.h"
#include "ident/report/report_text.h"

DEFINE_string(model, "", "model that pushid-fit --model_out wrote; the checks are added to it");
DEFINE_string(model_out, "", "write the model with the checks here (JSON) instead of to --model");
DEFINE_string(seed, "", "seed of all random numbers (default: that of the fit)");
DEFINE_int32(num_threads, 1, "threads; results are the same for any number");

namespace {

using namespace pushid;

uint64_t SeedOf(const FitOptions& options) {
  if (FLAGS_seed.empty()) return options.seed;
  FitOptions given;
  OrFail(FindFitOption("seed")->apply(FLAGS_seed, &given));
  return given.seed;
}

// The recordings of the model, loaded as the fit loaded them, and the bodies of --body_weight.
std::vector<PendulumRecording> LoadFitted(FittedModel* model) {
  const std::map<std::string, std::string>& fit_flags = model->provenance.configuration;
  FitOptions& options = model->fit.options;
  LoadAs(fit_flags);
  const auto loaded = LoadFittedRecordings(model->fit, NeedsJoints(options));
  if (options.body_weight > 0.0) {
    const auto folder = fit_flags.find("body_restoration");
    options.body = OrFail(LoadBodyData(folder == fit_flags.end() ? "" : folder->second,
                                       "--body_restoration of the fit", loaded, options.mapping));
  }
  return OrFail(AsFitted(MakePendulumRecordings(loaded, options.mapping), model->fit));
}

// A model says how it was made: with these flags too.
void AddToProvenance(Provenance* from) {
  const std::map<std::string, std::string> now = EffectiveFlags();
  std::vector<std::string>& known = from->changed_flags;
  std::vector<std::string> added;
  for (const std::string& name : ChangedFlags()) {
    if (!MovedCheckFlags().Has(name) && name != "bootstrap_by") continue;
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
  const uint64_t seed = SeedOf(model.fit.options);
  const ModelChecks checks = ModelChecksFromCommandLine(seed, FLAGS_num_threads);
  if (!checks.Any()) {
    return Fail(
        "nothing is asked; give one of --profile, --bootstrap=199, --prior_check, "
        "--push_check, --horizon_check, --learn_forecasts, --design=all or --population");
  }
  const std::string& out = FLAGS_model_out.empty() ? FLAGS_model : FLAGS_model_out;
  const bool writes = checks.Adds() || !FLAGS_model_out.empty();
  if (writes) OrFail(CheckWritable(out));
  const std::vector<PendulumRecording> recordings = LoadFitted(&model);
  OrFail(CheckAgainst(checks, model.fit.options, recordings));
  OrFail(ResumeFit(recordings, &model.fit));
  AddToProvenance(&model.provenance);
  model.provenance.model_file = out;
  AddFlaggedChecks(recordings, checks, &model);
  const std::string sections = OrFail(CheckSections(recordings, checks, model.fit));
  std::printf("%s%s", ReportText(model).c_str(), sections.c_str());
  if (!writes) return kDone;
  OrFail(WriteModelFile(out, model, FLAGS_num_threads, begin));
  std::printf("model with the checks written to %s\n", out.c_str());
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  pushid::AllowBareProfile(argc, argv);
  return pushid::RunApp(
      argc, argv,
      "pushid-check questions a fitted model with the recordings that it was fitted to: profiles, "
      "bootstrap,\nother priors, pushes and horizons, what to record next. It adds the results to "
      "the model's file\n(or writes them to --model_out); reports and advice use them.\n\n"
      "  pushid-check --model=model.json --recordings=M/manifest.json --bootstrap=199 --profile",
      Run);
}
