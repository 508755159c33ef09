// apps: pushid-fit: recordings in, identified parameters out.
#include "apps/flags/command_line.h"
#include "apps/flags/fit_option_flags.h"
#include "apps/flags/recording_flags.h"
#include "ident/fit/fit.h"
#include "ident/model/model_json.h"
#include "ident/parameters/parameter_table.h"
#include "ident/parameters/presets.h"
#include "ident/report/advice.h"
#include "ident/report/page/build_report.h"
#include "ident/report/report_text.h"
#include "ident/uncertainty/bootstrap.h"

DEFINE_string(model_out, "", "write the identified model here (JSON)");
DEFINE_bool(details, false, "print the whole report instead of one screen");
DEFINE_int32(replica, 0,
             "fit bootstrap replica k: as many people or recordings, drawn with "
             "replacement from --seed and k; 0: the recordings as they are");
DEFINE_bool(check, false, "only check the flags: nothing is read, fitted or written");
DEFINE_bool(list_parameters, false,
            "only print every parameter: name, symbol, unit, meaning, when to free it (Markdown)");

namespace {

using namespace pushid;

int Run() {
  const double begin = Now();
  if (FLAGS_replica < 0) return Fail("--replica must not be negative");
  if (FLAGS_list_parameters) {
    std::printf("%s", ParameterGlossary().c_str());
    return kDone;
  }
  const FitSetup setup = FitSetupFromFlags();
  const FitOptions& roughly = setup.roughly();
  CheckRecordingFlags();
  if (FLAGS_check) return kDone;
  if (!FLAGS_model_out.empty()) OrFail(CheckWritable(FLAGS_model_out));
  Warnings file_warnings;  // a result says what it was made of
  const std::vector<Recording> recordings =
      LoadFlaggedRecordings({}, NeedsJoints(roughly.model), &file_warnings, true);
  CheckPushed(recordings);
  const std::vector<PendulumRecording> pendulums =
      Resampled(MakePendulumRecordings(recordings), ClusterBy::kAuto, Seed(), FLAGS_replica);

  FitOptions options = OrFail(setup.For(pendulums));
  for (const std::string& warning : OptionWarnings(GivenFitFlags(), options))
    LOG(WARNING) << warning;
  Warnings unit_warnings;
  const MaybeError unprepared = PrepareFit(pendulums, &options, &unit_warnings);
  WarnGrouped(unit_warnings);
  OrFail(unprepared);

  ProgressLine line;
  FittedModel model;
  FitResult& result = model.fit;
  const auto show = [&line](const std::string& phase, int iteration, double cost) {
    line.Show("fitting " + phase + ": iteration " + std::to_string(iteration) + ", cost " +
              Rounded(cost, 6));
  };
  result = FitAnyStance(pendulums, options, setup.OtherStances(pendulums, options), show);
  line.Finish();
  if (!result.ok()) return Fail("the fit failed: " + result.message, kFitFailed);
  result.warnings.insert(result.warnings.begin(), file_warnings.begin(), file_warnings.end());
  model.provenance = ProvenanceOfRun();
  model.provenance.model_file = FLAGS_model_out;
  model.advice = Advise(model);

  std::printf("%s", (FLAGS_details ? DetailsText(model) : ScreenOf(model).ToString()).c_str());
  if (!FLAGS_model_out.empty()) {
    OrFail(WriteFittedModel(FLAGS_model_out, model, NumThreads(), Now() - begin));
  }
  if (result.converged) return kDone;
  return Fail("the fit did not converge: " + result.message, kFitFailed);
}

}  // namespace

int main(int argc, char** argv) {
  return pushid::RunApp(
      argc, argv,
      "pushid-fit identifies friction, balance gains and the push tail from recordings of pushes.\n"
      "  pushid-fit --recordings=recordings/manifest.json --setting=single --model_out=model.json",
      Run);
}
