// apps: writing figures and tables for papers.
#include "apps/figure_outputs.h"

#include <gflags/gflags.h>

#include <cstdio>
#include <filesystem>

#include "apps/flags/overwrite_flag.h"
#include "apps/support/processes.h"
#include "datasets/files/atomic_file.h"
#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "ident/report/report_tables.h"

DEFINE_string(figures_out, "",
              "folder for every figure alone, the numbers behind every figure and table (CSV), "
              "captions, and the table of "
              "parameters (LaTeX, Markdown)");
DEFINE_string(figure_format, "svg", "of --figures_out: svg, pdf or png (600 dots per inch)");
DEFINE_double(figure_width, 85.0, "width of each figure, mm: that of a journal's column");
DEFINE_double(figure_font, 8.0, "size of the smallest labels of figures, points");

namespace pushid {
namespace {

namespace fs = std::filesystem;

// Of Debian's librsvg2-bin.
constexpr char kConverter[] = "rsvg-convert";
constexpr char kResolution[] = "600";

// Each picture in its turn. An interrupt ends it, and the folder's destructor cleans up.
MaybeError Convert(const std::string& folder) {
  SignalReader reader;
  std::vector<fs::path> pictures;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".svg") pictures.push_back(entry.path());
  }
  const std::string log = (fs::path(folder) / "convert.log").string();
  for (const fs::path& svg : pictures) {
    fs::path converted = svg;
    converted.replace_extension(FLAGS_figure_format);
    const Result<pid_t> child =
        StartChild({{FindProgram(kConverter), "--dpi-x", kResolution, "--dpi-y", kResolution,
                     "--format", FLAGS_figure_format, "--output", converted.string(), svg.string()},
                    log,
                    log});
    if (!child.ok()) return child.error();
    ChildEnd end;
    while (end.pid == 0) {
      reader.Wait(1000);
      if (reader.interrupted()) {
        KillChild(child.value(), SIGKILL);
        return Error{"interrupted; nothing was written"};
      }
      end = NextEnded();
    }
    if (end.exit_code != 0) {
      return Error{
          std::string(kConverter) + " failed on a figure of this name: try --figure_format=svg",
          svg.filename().string()};
    }
    fs::remove(svg);
  }
  fs::remove(log);
  return std::nullopt;
}

}  // namespace

bool FiguresAsked() { return !FLAGS_figures_out.empty(); }

MaybeError CheckFigureFlags() {
  if (!FiguresAsked()) return std::nullopt;
  if (FLAGS_figure_format != "svg" && FLAGS_figure_format != "pdf" &&
      FLAGS_figure_format != "png") {
    return Error{"--figure_format is " + Quoted(FLAGS_figure_format) +
                 "; it must be svg, pdf or png"};
  }
  if (!(FLAGS_figure_width >= 40.0 && FLAGS_figure_width <= 1000.0)) {
    return Error{"--figure_width is " + Rounded(FLAGS_figure_width) + "; it must be 40 to 1000 mm"};
  }
  if (!(FLAGS_figure_font >= 4.0 && FLAGS_figure_font <= 40.0)) {
    return Error{"--figure_font is " + Rounded(FLAGS_figure_font) + "; it must be 4 to 40 points"};
  }
  if (FLAGS_figure_format != "svg" && FindProgram(kConverter).empty()) {
    return Error{
        "--figure_format=" + FLAGS_figure_format + " needs " + kConverter +
        ", which is not installed: apt-get install librsvg2-bin, or use --figure_format=svg"};
  }
  std::error_code ignored;
  if (!fs::exists(FLAGS_figures_out, ignored)) return AtomicFolder().Open(FLAGS_figures_out);
  if (!fs::is_directory(FLAGS_figures_out, ignored))
    return Error{"--figures_out names a file; name a folder", FLAGS_figures_out};
  if (fs::is_empty(FLAGS_figures_out, ignored)) return std::nullopt;
  const std::string captions = (fs::path(FLAGS_figures_out) / kCaptionsFile).string();
  if (fs::exists(captions, ignored)) return CheckNew("figures_out", captions);
  return Error{"holds other files than figures of pushid-report; choose another --figures_out",
               FLAGS_figures_out};
}

MaybeError WriteFigures(const FittedModel& model, const Report& report) {
  AtomicFolder folder;
  if (MaybeError failed = folder.Open(FLAGS_figures_out)) return failed;
  std::vector<NamedText> files = FigureFiles(report, FLAGS_figure_width, FLAGS_figure_font);
  const TextTable parameters = PaperTable(model.fit);
  files.emplace_back("parameters.tex", LatexOf(parameters));
  files.emplace_back("parameters.md", MarkdownOf(parameters));
  for (const auto& [name, text] : files) {
    const std::string path = (fs::path(folder.path()) / name).string();
    if (MaybeError failed = WriteFileAtomically(path, text)) return failed;
  }
  if (FLAGS_figure_format != "svg") {
    if (MaybeError failed = Convert(folder.path())) return failed;
  }
  if (MaybeError failed = folder.Commit()) return failed;
  std::fprintf(stderr, "figures and tables written to %s\n", FLAGS_figures_out.c_str());
  return std::nullopt;
}

}  // namespace pushid
