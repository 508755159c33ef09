// apps: pushid-report: an identified model in words and tables, and as a page with pictures.
#include <gflags/gflags.h>

#include <cstdio>
#include <string>

#include "apps/explore/explore_section.h"
#include "apps/figure_outputs.h"
#include "apps/flags/command_line.h"
#include "apps/flags/recording_flags.h"
#include "datasets/files/atomic_file.h"
#include "datasets/files/error.h"
#include "ident/model/model_json.h"
#include "ident/report/page/build_report.h"
#include "ident/report/page/document.h"
#include "ident/report/report_text.h"

DEFINE_string(model, "", "model that pushid-fit --model_out wrote");
DEFINE_string(truth, "", "manifest.json of pushid-simulate: only compare with its true values");
DEFINE_string(html_out, "", "write the whole report here: one self-contained page (HTML)");
DEFINE_bool(explore, true,
            "the page has a person to try the model on, with sliders (programs that were built "
            "with emscripten)");
DEFINE_bool(text, false, "print the whole report, not only the parameters");
DEFINE_int32(num_threads, 1, "threads");

namespace {

using namespace pushid;

// The recordings to draw: those of the flags, or those that were fitted.
Result<std::vector<Recording>> RecordingsOf(const FitResult& fit) {
  if (FLAGS_recordings.empty()) return std::vector<Recording>();
  return LoadFlaggedRecordings(FittedIds(fit), true);
}

int WriteWhole(const FittedModel& model) {
  const Result<std::vector<Recording>> recordings = RecordingsOf(model.fit);
  if (!recordings.ok()) return Fail(recordings.error());
  ProgressLine line;
  BuildReportOptions options;
  options.num_threads = FLAGS_num_threads;
  options.progress = line.OfJobs("recording");
  Report report = BuildReport(model, recordings.value(), options);
  line.Finish();
  if (FLAGS_text) std::printf("%s", ToText(report).c_str());
  if (FiguresAsked()) {
    if (MaybeError error = WriteFigures(model, report)) return Fail(*error);
  }
  if (FLAGS_html_out.empty()) return kDone;
  if (FLAGS_explore) report.sections.insert(report.sections.begin() + 1, ExploreSection(model));
  if (MaybeError error = WriteFileAtomically(FLAGS_html_out, ToPage(report))) return Fail(*error);
  std::fprintf(stderr, "report written to %s\n", FLAGS_html_out.c_str());
  if (recordings.value().empty()) {
    Warn("without --recordings the report shows no motion and no figure");
  }
  return kDone;
}

int Run() {
  for (MaybeError error :
       {Require("model", FLAGS_model, "give a file that pushid-fit --model_out wrote"),
        CheckPageName("--html_out", FLAGS_html_out), CheckOutputFiles({FLAGS_html_out}),
        CheckFigureFlags()}) {
    if (error) return Fail(*error);
  }
  const Result<FittedModel> model = ReadFittedModel(FLAGS_model);
  if (!model.ok()) return Fail(model.error());
  if (!FLAGS_truth.empty()) {
    const Result<std::map<std::string, double>> truth = ReadTruth(FLAGS_truth);
    if (!truth.ok()) return Fail(truth.error());
    std::printf("%s", TruthTable(model.value().fit, truth.value()).c_str());
    return kDone;
  }
  if (FLAGS_text || !FLAGS_html_out.empty() || FiguresAsked()) return WriteWhole(model.value());
  std::printf("%s", ReportText(model.value()).c_str());
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  return RunApp(
      argc, argv,
      "pushid-report prints the report of an identified model, or writes it as an HTML page.\n\n"
      "  pushid-report --model=model.json\n"
      "  pushid-report --model=model.json --recordings=M/manifest.json --html_out=report.html\n"
      "  pushid-report --model=model.json --recordings=M/manifest.json --figures_out=figures "
      "--figure_format=pdf",
      Run);
}
