// apps: pushid-report: an identified model in words and tables, and as a page with pictures.
#include "apps/flags/command_line.h"
#include "apps/flags/overwrite_flag.h"
#include "apps/flags/recording_flags.h"
#include "ident/model/model_json.h"
#include "ident/report/document.h"
#include "ident/report/page/build_report.h"
#include "ident/report/parameter_sections.h"
#include "ident/report/report_text.h"

DEFINE_string(model, "", "model that pushid-fit --model_out wrote");
DEFINE_string(truth, "", "manifest.json of pushid-simulate: only compare with its true values");
DEFINE_string(html_out, "", "write the whole report here: one self-contained page (HTML)");
DEFINE_bool(details, false, "print the whole report instead of one screen");
DEFINE_int32(num_threads, 1, "threads");

DEFINE_string(
    figures_out, "",
    "folder for every figure alone (SVG), the numbers behind every figure and table (CSV) "
    "and captions");

namespace {

using namespace pushid;

namespace fs = std::filesystem;

// Refuses, before anything is computed, a folder with other files in it.
void CheckFigureFlags() {
  if (FLAGS_figures_out.empty()) return;
  std::error_code ignored;
  if (!fs::exists(FLAGS_figures_out, ignored)) {
    return OrFail(AtomicFolder().Open(FLAGS_figures_out));
  }
  if (!fs::is_directory(FLAGS_figures_out, ignored))
    throw Error{"--figures_out names a file; name a folder", FLAGS_figures_out};
  if (fs::is_empty(FLAGS_figures_out, ignored)) return;
  const std::string captions = (fs::path(FLAGS_figures_out) / kCaptionsFile).string();
  if (fs::exists(captions, ignored)) return OrFail(CheckNew("figures_out", captions));
  throw Error{"holds other files than figures of pushid-report; choose another --figures_out",
              FLAGS_figures_out};
}

// Writes the whole folder or nothing of it.
void WriteFigures(const Report& report) {
  AtomicFolder folder;
  OrFail(folder.Open(FLAGS_figures_out));
  for (const auto& [name, text] : FigureFiles(report)) {
    const std::string path = (fs::path(folder.path()) / name).string();
    OrFail(WriteFileAtomically(path, text));
  }
  OrFail(folder.Commit());
  LOG(INFO) << "figures and tables written to " << FLAGS_figures_out;
}

int WriteWhole(const FittedModel& model) {
  std::vector<Recording> recordings;  // to draw
  if (!FLAGS_recordings.empty()) recordings = LoadFittedRecordings(model.fit, true);
  ProgressLine line;
  const Report report = BuildReport(model, recordings, FLAGS_num_threads, line.OfJobs("recording"));
  line.Finish();
  if (FLAGS_details) std::printf("%s", ToText(report).c_str());
  if (!FLAGS_figures_out.empty()) WriteFigures(report);
  if (FLAGS_html_out.empty()) return kDone;
  OrFail(WriteFileAtomically(FLAGS_html_out, ToPage(report)));
  LOG(INFO) << "report written to " << FLAGS_html_out;
  if (recordings.empty()) {
    LOG(WARNING) << "without --recordings the report shows no motion and no figure";
  }
  return kDone;
}

int Run() {
  Require("model", FLAGS_model, "give a file that pushid-fit --model_out wrote");
  OrFail(CheckPageName("--html_out", FLAGS_html_out));
  OrFail(CheckOutputFiles({FLAGS_html_out}));
  CheckFigureFlags();
  const FittedModel model = OrFail(ReadFittedModel(FLAGS_model));
  if (!FLAGS_truth.empty()) {
    const std::map<std::string, double> truth = OrFail(ReadTruth(FLAGS_truth));
    std::printf("%s", TruthTable(model.fit, truth).c_str());
    return kDone;
  }
  if (FLAGS_details || !FLAGS_html_out.empty() || !FLAGS_figures_out.empty()) {
    return WriteWhole(model);
  }
  std::printf("%s", ScreenOf(model).ToString().c_str());
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  return RunApp(
      argc, argv,
      "pushid-report prints the report of a fitted model, or writes it as a page or as figures.\n"
      "  pushid-report --model=model.json --recordings=recordings/manifest.json "
      "--html_out=report.html",
      Run);
}
