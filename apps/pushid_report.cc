// apps: pushid-report: an identified model in words and tables, and as a page with pictures.
#include <cstdio>

#include "apps/flags/command_line.h"
#include "apps/flags/recording_flags.h"
#include "apps/flags/report_flags.h"
#include "datasets/files/atomic_file.h"
#include "ident/model/model_json.h"
#include "ident/report/page/build_report.h"
#include "ident/report/page/document.h"
#include "ident/report/report_text.h"

namespace {

using namespace pushid;

// The recordings to draw: those of the flags, or those that were fitted.
Result<std::vector<Recording>> RecordingsOf(const FitResult& fit) {
  const RecordingFlags flags = RecordingFlagsFromCommandLine();
  if (flags.manifest.empty()) return std::vector<Recording>();
  std::vector<std::string> ids;
  for (const FittedRecording& r : fit.recordings) {
    if (!flags.chosen) ids.push_back(r.id);
  }
  return LoadFlaggedRecordings(ids, true);
}

int WriteWhole(const ReportFlags& flags, const FittedModel& model) {
  const Result<std::vector<Recording>> recordings = RecordingsOf(model.fit);
  if (!recordings.ok()) return Fail(recordings.error());
  ProgressLine line;
  BuildReportOptions options;
  options.num_threads = flags.num_threads;
  options.progress = [&line](int done, int total) {
    line.Show("recording " + std::to_string(done) + " of " + std::to_string(total));
  };
  const Report report = BuildReport(model, recordings.value(), options);
  line.Finish();
  if (flags.text) std::printf("%s", ToText(report).c_str());
  if (!flags.csv_dir.empty()) {
    if (MaybeError error = WriteNumbers(report, flags.csv_dir)) return Fail(*error);
    std::fprintf(stderr, "numbers written to %s\n", flags.csv_dir.c_str());
  }
  if (flags.html_out.empty()) return kDone;
  if (MaybeError error = WriteFileAtomically(flags.html_out, ToPage(report))) return Fail(*error);
  std::fprintf(stderr, "report written to %s\n", flags.html_out.c_str());
  if (recordings.value().empty()) {
    Warn("without --recordings the report shows no motion and no figure");
  }
  return kDone;
}

int Run() {
  const Result<ReportFlags> read = ReportFlagsFromCommandLine();
  if (!read.ok()) return Fail(read.error());
  const ReportFlags& flags = read.value();
  const Result<FittedModel> model = ReadFittedModel(flags.model);
  if (!model.ok()) return Fail(model.error());
  if (!flags.truth.empty()) {
    const Result<std::map<std::string, double>> truth = ReadTruth(flags.truth);
    if (!truth.ok()) return Fail(truth.error());
    std::printf("%s", TruthTable(model.value().fit, truth.value()).c_str());
    return kDone;
  }
  if (flags.whole()) return WriteWhole(flags, model.value());
  std::printf("%s", ReportText(model.value()).c_str());
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  return RunApp(
      argc, argv,
      "pushid-report prints the report of an identified model, or writes it as an HTML page.\n\n"
      "  pushid-report --model=model.json\n"
      "  pushid-report --model=model.json --recordings=M/manifest.json --html_out=report.html",
      Run);
}
