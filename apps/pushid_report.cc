// apps: pushid-report: an identified model in words and tables, and as a page with pictures.
#include <gflags/gflags.h>

#include <cstdio>
#include <filesystem>
#include <string>

#include "apps/flags/command_line.h"
#include "apps/flags/recording_flags.h"
#include "apps/support/processes.h"
#include "datasets/files/atomic_file.h"
#include "datasets/files/error.h"
#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "ident/model/model_json.h"
#include "ident/report/page/build_report.h"
#include "ident/report/page/document.h"
#include "ident/report/report_text.h"

DEFINE_string(model, "", "model that pushid-fit --model_out wrote");
DEFINE_string(truth, "", "manifest.json of pushid-simulate: only compare with its true values");
DEFINE_string(html_out, "", "write the whole report here: one self-contained page (HTML)");
DEFINE_bool(text, false, "print the whole report, not only the parameters");
DEFINE_int32(num_threads, 1, "threads");

DEFINE_string(figures_out, "",
              "folder for every figure alone, the numbers behind every figure and table (CSV), "
              "captions, and the table of "
              "parameters (LaTeX, Markdown)");
DEFINE_string(figure_format, "svg", "of --figures_out: svg, pdf or png (600 dots per inch)");
DEFINE_double(figure_width, 85.0, "width of each figure, mm: that of a journal's column");
DEFINE_double(figure_font, 8.0, "size of the smallest labels of figures, points");

namespace {

using namespace pushid;

namespace fs = std::filesystem;

// Of Debian's librsvg2-bin.
constexpr char kConverter[] = "rsvg-convert";
constexpr char kResolution[] = "600";

// Each picture in its turn. An interrupt ends it, and the folder's destructor cleans up.
void Convert(const std::string& folder) {
  SignalReader reader;
  std::vector<fs::path> pictures;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".svg") pictures.push_back(entry.path());
  }
  const std::string log = (fs::path(folder) / "convert.log").string();
  for (const fs::path& svg : pictures) {
    fs::path converted = svg;
    converted.replace_extension(FLAGS_figure_format);
    const pid_t child = OrFail(
        StartChild({{FindProgram(kConverter), "--dpi-x", kResolution, "--dpi-y", kResolution,
                     "--format", FLAGS_figure_format, "--output", converted.string(), svg.string()},
                    log,
                    log}));
    ChildEnd end;
    while (end.pid == 0) {
      reader.Wait(1000);
      if (reader.interrupted()) {
        KillChild(child, SIGKILL);
        throw Error{"interrupted; nothing was written"};
      }
      end = NextEnded();
    }
    if (end.exit_code != 0) {
      throw Error{
          std::string(kConverter) + " failed on a figure of this name: try --figure_format=svg",
          svg.filename().string()};
    }
    fs::remove(svg);
  }
  fs::remove(log);
}

bool FiguresAsked() { return !FLAGS_figures_out.empty(); }

// Before anything is computed: flags that make no sense, a folder with other things in it, or no
// program that makes PDF and PNG of SVG.
void CheckFigureFlags() {
  if (!FiguresAsked()) return;
  if (FLAGS_figure_format != "svg" && FLAGS_figure_format != "pdf" &&
      FLAGS_figure_format != "png") {
    throw Error{"--figure_format is " + Quoted(FLAGS_figure_format) +
                "; it must be svg, pdf or png"};
  }
  if (!(FLAGS_figure_width >= 40.0 && FLAGS_figure_width <= 1000.0)) {
    throw Error{"--figure_width is " + Rounded(FLAGS_figure_width) + "; it must be 40 to 1000 mm"};
  }
  if (!(FLAGS_figure_font >= 4.0 && FLAGS_figure_font <= 40.0)) {
    throw Error{"--figure_font is " + Rounded(FLAGS_figure_font) + "; it must be 4 to 40 points"};
  }
  if (FLAGS_figure_format != "svg" && FindProgram(kConverter).empty()) {
    throw Error{
        "--figure_format=" + FLAGS_figure_format + " needs " + kConverter +
        ", which is not installed: apt-get install librsvg2-bin, or use --figure_format=svg"};
  }
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

// The folder as a whole, or nothing of it.
void WriteFigures(const FittedModel& model, const Report& report) {
  AtomicFolder folder;
  OrFail(folder.Open(FLAGS_figures_out));
  std::vector<NamedText> files = FigureFiles(report, FLAGS_figure_width, FLAGS_figure_font);
  const TextTable parameters = PaperTable(model.fit);
  files.emplace_back("parameters.tex", LatexOf(parameters));
  files.emplace_back("parameters.md", MarkdownOf(parameters));
  for (const auto& [name, text] : files) {
    const std::string path = (fs::path(folder.path()) / name).string();
    OrFail(WriteFileAtomically(path, text));
  }
  if (FLAGS_figure_format != "svg") Convert(folder.path());
  OrFail(folder.Commit());
  std::fprintf(stderr, "figures and tables written to %s\n", FLAGS_figures_out.c_str());
}

// The recordings to draw: those of the flags, or those that were fitted.
std::vector<Recording> RecordingsOf(const FitResult& fit) {
  if (FLAGS_recordings.empty()) return {};
  return LoadFittedRecordings(fit, true);
}

int WriteWhole(const FittedModel& model) {
  const std::vector<Recording> recordings = RecordingsOf(model.fit);
  ProgressLine line;
  const BuildReportOptions options{FLAGS_num_threads, line.OfJobs("recording")};
  const Report report = BuildReport(model, recordings, options);
  line.Finish();
  if (FLAGS_text) std::printf("%s", ToText(report).c_str());
  if (FiguresAsked()) WriteFigures(model, report);
  if (FLAGS_html_out.empty()) return kDone;
  OrFail(WriteFileAtomically(FLAGS_html_out, ToPage(report)));
  std::fprintf(stderr, "report written to %s\n", FLAGS_html_out.c_str());
  if (recordings.empty()) {
    Warn("without --recordings the report shows no motion and no figure");
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
  if (FLAGS_text || !FLAGS_html_out.empty() || FiguresAsked()) return WriteWhole(model);
  std::printf("%s", ReportText(model).c_str());
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
