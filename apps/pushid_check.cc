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

Result<uint64_t> SeedOf(const FitOptions& options) {
  if (FLAGS_seed.empty()) return options.seed;
  FitOptions given;
  if (MaybeError error = FindFitOption("seed")->apply(FLAGS_seed, &given)) return *error;
  return given.seed;
}

// The recordings of the model, loaded as the fit loaded them, and the bodies of --body_weight.
Result<std::vector<PendulumRecording>> LoadFitted(FittedModel* model) {
  const std::map<std::string, std::string>& fit_flags = model->provenance.configuration;
  FitOptions& options = model->fit.options;
  LoadAs(fit_flags);
  const auto loaded = LoadFittedRecordings(model->fit, NeedsJoints(options));
  if (!loaded.ok()) return loaded.error();
  if (options.body_weight > 0.0) {
    const auto folder = fit_flags.find("body_restoration");
    const auto bodies =
        LoadBodyData(folder == fit_flags.end() ? "" : folder->second,
                     "--body_restoration of the fit", loaded.value(), options.mapping);
    if (!bodies.ok()) return bodies.error();
    options.body = bodies.value();
  }
  return AsFitted(MakePendulumRecordings(loaded.value(), options.mapping), model->fit);
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
  for (MaybeError error :
       {Require("model", FLAGS_model, "give a file that pushid-fit wrote"),
        CheckRange("num_threads", FLAGS_num_threads, 1, 1024), CheckRecordingFlags()}) {
    if (error) return Fail(*error);
  }
  Result<FittedModel> read = ReadFittedModel(FLAGS_model);
  if (!read.ok()) return Fail(read.error());
  FittedModel& model = read.value();
  const Result<uint64_t> seed = SeedOf(model.fit.options);
  if (!seed.ok()) return Fail(seed.error());
  const Result<ModelChecks> checks = ModelChecksFromCommandLine(seed.value(), FLAGS_num_threads);
  if (!checks.ok()) return Fail(checks.error());
  if (!checks.value().Any()) {
    return Fail(
        "nothing is asked; give one of --profile, --bootstrap=199, --prior_check, "
        "--push_check, --horizon_check, --learn_forecasts, --design=all and --population");
  }
  const std::string& out = FLAGS_model_out.empty() ? FLAGS_model : FLAGS_model_out;
  const bool writes = checks.value().Adds() || !FLAGS_model_out.empty();
  if (writes) {
    if (MaybeError error = CheckWritable(out)) return Fail(*error);
  }
  const Result<std::vector<PendulumRecording>> recordings = LoadFitted(&model);
  if (!recordings.ok()) return Fail(recordings.error());
  MaybeError failed = CheckAgainst(checks.value(), model.fit.options, recordings.value());
  if (!failed) failed = ResumeFit(recordings.value(), &model.fit);
  AddToProvenance(&model.provenance);
  model.provenance.model_file = out;
  if (!failed) failed = AddFlaggedChecks(recordings.value(), checks.value(), &model);
  if (failed) return Fail(*failed);
  const Result<std::string> sections = CheckSections(recordings.value(), checks.value(), model.fit);
  if (!sections.ok()) return Fail(sections.error());
  std::printf("%s%s", ReportText(model).c_str(), sections.value().c_str());
  if (!writes) return kDone;
  if (MaybeError error = WriteModelFile(out, model, FLAGS_num_threads, begin)) return Fail(*error);
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
