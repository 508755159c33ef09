// apps: pushid-inspect: what files hold, and what about them will matter.
#include <cmath>

#include "apps/flags/command_line.h"
#include "datasets/files/json_file.h"
#include "datasets/inspection/inspection.h"
#include "datasets/manifest/joint_mapping.h"
#include "ident/figures/chart.h"
#include "ident/figures/text_table.h"
#include "ident/formations/formation_run.h"

DEFINE_string(mapping, "", "mapping file: which columns or joints are hip and ankles, time, rate");
DEFINE_string(svg_out, "", "draw hip, steps and forces here (SVG); for one file");
DEFINE_string(json_out, "", "write what was found of all files here (JSON)");
DEFINE_bool(details, false, "print all that was found instead of one screen a file");
DEFINE_bool(wave, false,
            "instead: how a push travels through the people of trajectories, of a table with a "
            "point for each person, or of a manifest's groups; no model and no fit");

namespace {

using namespace pushid;

std::vector<std::string> g_files;

int RunWaves() {
  std::vector<MeasuredWave> all;
  int outcome = kDone;
  for (const std::string& file : g_files) {
    const Result<std::vector<MeasuredWave>> waves = MeasureWaves(file);
    if (!waves.ok()) {
      outcome = Fail(waves.error());
      continue;
    }
    for (const MeasuredWave& wave : waves.value()) {
      std::printf("%s\n", WaveText(wave).c_str());
      all.push_back(wave);
    }
  }
  std::printf("%s", WavesText(all).c_str());
  return outcome;
}

constexpr double kInspectionWidth = 1000;
constexpr std::size_t kMostPoints = 1500;  // of a line: more than there are pixels

// A chart of one line, which is broken where values are missing.
Chart SignalChart(const std::string& title, double rate_hz, const std::vector<double>& values) {
  Chart chart{title, "time, s"};
  chart.lines.push_back({{}, kMeasuredLook});
  for (std::size_t i = 0; i < values.size(); i += values.size() / kMostPoints + 1) {
    if (std::isfinite(values[i])) {
      chart.lines.back().points.emplace_back(static_cast<double>(i) / rate_hz, values[i]);
    } else if (!chart.lines.back().points.empty()) {
      chart.lines.push_back({{}, kMeasuredLook});
    }
  }
  return chart;
}

void AddHip(const Inspection& found, Figure* figure) {
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const Eigen::Vector3d& position : found.hip) values.push_back(position[axis]);
    Chart chart =
        SignalChart(std::string("hip ") + "xyz"[axis] + " displacement, m", found.rate_hz, values);
    if (found.onset_frame > 0) {
      chart.marks = {found.onset_frame / found.rate_hz};
      chart.x_label = "time, s (line: the hip has moved by 2 cm)";
    }
    for (Foot foot : kFeet) {
      if (!found.steps) continue;
      ChartLane lane{NameOf(foot), {}, kLiftedLook};
      for (const FootStep& step : found.steps->steps) {
        if (step.foot != foot) continue;
        lane.bars.emplace_back(step.lift_off / found.rate_hz, step.landing / found.rate_hz);
      }
      chart.lanes.push_back(lane);
    }
    figure->panels.push_back(chart);
  }
  if (found.steps) figure->legend = {{"foot off the ground", kLiftedLook}};
}

// A panel for each of these that was found: the hip's three coordinates less those of its first
// frame, with the onset marked; when each foot is off the ground; forces.
std::string InspectionSvg(const Inspection& found) {
  Figure figure;
  figure.heading = found.path + ": " + found.format;
  if (!found.hip.empty() && found.rate_hz > 0.0) AddHip(found, &figure);
  for (const InspectedSignal& force : found.forces) {
    figure.panels.push_back(SignalChart(force.name + ", N", force.rate_hz, force.values));
  }
  return DrawFigure(figure, kInspectionWidth, found.path).ToString();
}

Screen ScreenOf(const Inspection& found) {
  Screen screen{found.path + ": " + found.format};
  TextTable table({"what", "found"});
  for (const auto& [what, said] : found.facts) table.Add({what, said});
  screen.tables = {table};
  screen.warnings = found.warnings;
  return screen;
}

int Run() {
  if (g_files.empty()) {
    throw Error{"name one or more files to inspect; see pushid-inspect --help"};
  }
  if (!FLAGS_svg_out.empty() || !FLAGS_json_out.empty()) {
    if (FLAGS_wave) throw Error{"--wave writes no files; leave --svg_out and --json_out out"};
    for (const std::string& file : g_files) OrFail(CheckNotRead("the command line", file));
  }
  if (!FLAGS_svg_out.empty() && g_files.size() > 1) {
    throw Error{"--svg_out draws one file, not " + std::to_string(g_files.size())};
  }
  OrFail(CheckOutputFiles({FLAGS_svg_out, FLAGS_json_out}));
  if (FLAGS_wave) return RunWaves();
  const ColumnMapping mapping =
      FLAGS_mapping.empty() ? ColumnMapping() : OrFail(ReadColumnMapping(FLAGS_mapping));
  // A file that cannot be read does not keep the others from being told about.
  int outcome = kDone;
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const std::string& file : g_files) {
    const Result<Inspection> found = Inspect(file, mapping);
    if (!found.ok()) {
      outcome = Fail(found.error());
      continue;
    }
    std::printf("%s", FLAGS_details ? TextLines(InspectionText(found.value())).c_str()
                                    : ScreenOf(found.value()).ToString().c_str());
    all.push_back(InspectionJson(found.value()));
    if (FLAGS_svg_out.empty()) continue;
    const Inspection& seen = found.value();
    if (seen.hip.empty() && seen.forces.empty()) {
      return Fail(file + ": a " + seen.format +
                  " contains nothing to draw; give the file of a recording");
    }
    OrFail(WriteFileAtomically(FLAGS_svg_out, InspectionSvg(found.value())));
    std::printf("  picture         %s\n", FLAGS_svg_out.c_str());
  }
  if (!FLAGS_json_out.empty()) OrFail(WriteJson(FLAGS_json_out, all, 1));
  return outcome;
}

}  // namespace

int main(int argc, char** argv) {
  return pushid::RunApp(argc, argv,
                        "pushid-inspect shows what files contain (BVH, C3D, TRC, STO, MOT, CSV, "
                        "manifests), with warnings.\n"
                        "  pushid-inspect recordings/bvh/S01_00_weak.bvh recordings/manifest.json",
                        Run, &g_files);
}
