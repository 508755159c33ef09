// apps: pushid-fit: recordings in, identified parameters out.
#include <gflags/gflags.h>

#include <chrono>
#include <cstdio>
#include <ctime>

#include "apps/flags/command_line.h"
#include "apps/flags/confidence_flags.h"
#include "apps/flags/fit_flag_checks.h"
#include "apps/flags/fit_flags.h"
#include "apps/flags/recording_flags.h"
#include "apps/support/app_support.h"
#include "datasets/files/atomic_file.h"
#include "datasets/files/json_file.h"
#include "datasets/files/number_text.h"
#include "ident/report/advice.h"
#include "ident/report/report_text.h"
#include "ident/results/result_json.h"
#include "ident/solver/large_network_stage.h"
#include "ident/uncertainty/bootstrap.h"

DECLARE_uint64(seed);
DECLARE_string(bootstrap_file);

DEFINE_string(model_out, "", "write the identified model here (JSON)");
DEFINE_int32(
    resample, 0,
    "fit replica k of a bootstrap: as many recordings drawn with replacement by --seed and "
    "k; 0: the recordings as they are");
DEFINE_bool(check, false, "only check the flags: nothing is read, fitted or written");

namespace {

std::string Today() {
  char text[32];
  const std::time_t now = std::time(nullptr);
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", std::gmtime(&now));
  return text;
}

// The recordings of replica k, those drawn several times standing there several times.
std::vector<pushid::Recording> Resampled(const std::vector<pushid::Recording>& recordings) {
  if (FLAGS_resample == 0) return recordings;
  const std::vector<int> counts =
      pushid::DrawRecordings(static_cast<int>(recordings.size()), FLAGS_seed, FLAGS_resample);
  std::vector<pushid::Recording> drawn;
  for (size_t i = 0; i < recordings.size(); ++i) {
    drawn.insert(drawn.end(), counts[i], recordings[i]);
  }
  return drawn;
}

int Run() {
  using namespace pushid;
  const auto begin = std::chrono::steady_clock::now();
  Result<FitOptions> options = FitOptionsFromFlags();
  if (!options.ok()) return Fail(options.error());
  if (MaybeError error = CheckConfidenceFlags()) return Fail(*error);
  if (FLAGS_resample < 0) return Fail("--resample must not be negative");
  if (MaybeError error = CheckRecordingFlags()) return Fail(*error);
  if (FLAGS_check) return kDone;
  for (const std::string& warning : FlagWarnings(options.value())) Warn(warning);
  if (!FLAGS_model_out.empty()) {
    if (MaybeError error = CheckWritable(FLAGS_model_out)) return Fail(*error);
  }
  std::vector<std::string> file_warnings;  // about the files; a result says what it was made of
  const Result<std::vector<Recording>> recordings =
      LoadFlaggedRecordings({}, false, &file_warnings);
  if (!recordings.ok()) return Fail(recordings.error());
  if (MaybeError error = CheckPushed(recordings.value())) return Fail(*error);
  const std::vector<PendulumRecording> pendulums =
      MapRecordings(Resampled(recordings.value()), options.value().mapping);

  HoldUnusedTail(pendulums, &options.value());
  if (options.value().table.Free().empty()) {
    return Fail("every parameter that acts on these recordings is fixed: nothing is left to fit");
  }
  const int count = static_cast<int>(pendulums.size());
  if (MaybeError error = CheckConfidence(options.value(), count)) return Fail(*error);
  for (const std::string& warning : UnitWarnings(pendulums)) Warn(warning);
  // A large network has no force yet and no Jacobian at all: the physical model is what is checked.
  FitOptions checked = options.value();
  if (NeedsGradientTraining(checked)) checked = PhysicsAlone(checked);
  if (MaybeError error = CheckEffects(FitProblem(pendulums, checked))) return Fail(*error);

  ProgressLine line;
  FitResult result = Fit(pendulums, options.value(),
                         [&line](const std::string& phase, int iteration, double cost) {
                           line.Show("fitting " + phase + ": iteration " +
                                     std::to_string(iteration) + ", cost " + Rounded(cost, 6));
                         });
  line.Finish();
  if (!result.ok()) {
    std::fprintf(stderr, "pushid-fit: the fit failed: %s\n", result.message.c_str());
    return kFitFailed;
  }
  if (MaybeError error = AddConfidence(pendulums, &result)) return Fail(*error);
  result.warnings.insert(result.warnings.begin(), file_warnings.begin(), file_warnings.end());
  result.version = Version();
  result.configuration = EffectiveFlags();
  // Where the data lay is no part of what was found; the hash is.
  result.configuration.erase("recordings");
  result.changed_flags = ChangedFlags();
  result.manifest = FLAGS_recordings;
  result.setting = FLAGS_setting;
  const Result<std::string> hash = HashFile(FLAGS_recordings);
  if (hash.ok()) result.manifest_hash = hash.value();
  result.diagnostics.advice = Advise(result);
  const Result<std::string> design = FlaggedDesign(pendulums, result);
  if (!design.ok()) return Fail(design.error());

  std::printf("%s%s", ReportText(result).c_str(), design.value().c_str());
  if (!FLAGS_model_out.empty()) {
    RunInfo run;
    run.date = Today();
    run.host = HostName();
    run.model_path = FLAGS_model_out;
    run.num_threads = NumThreads();
    run.total_seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (MaybeError error = WriteJson(FLAGS_model_out, ToJson(result, run))) return Fail(*error);
    std::printf("model written to %s\n", FLAGS_model_out.c_str());
  }
  if (result.converged) return kDone;
  std::fprintf(stderr, "pushid-fit: the fit did not converge: %s\n", result.message.c_str());
  return kFitFailed;
}

}  // namespace

int main(int argc, char** argv) {
  pushid::AllowBareProfile(argc, argv);
  return pushid::RunApp(argc, argv,
                        "pushid-fit identifies friction, balance gains and the push tail from push "
                        "recordings.\n\n  pushid-fit --recordings=M/manifest.json --setting=single "
                        "--model_out=model.json",
                        Run);
}
