// apps: pushid-inspect: what files hold, and what about them will matter.
#include <gflags/gflags.h>

#include <cstdio>
#include <string>
#include <vector>

#include "apps/flags/command_line.h"
#include "datasets/files/atomic_file.h"
#include "datasets/files/json_file.h"
#include "datasets/inspection/inspection.h"
#include "datasets/manifest/joint_mapping.h"
#include "ident/formations/wave_speed.h"
#include "ident/report/inspection_svg.h"

DEFINE_string(mapping, "", "mapping file: which columns or joints are hip and ankles, time, rate");
DEFINE_string(svg_out, "", "draw hip, gaps and forces here (SVG); for one file");
DEFINE_string(json_out, "", "write what was found of all files here (JSON)");
DEFINE_bool(wave, false,
            "instead: how a push travels through the people of trajectories, of a table with a "
            "point for each person, or of a manifest's groups; no model and no fit");

namespace {

using namespace pushid;

std::vector<std::string> g_files;

void CheckFlags() {
  if (g_files.empty()) {
    throw Error{"name one or more files to inspect; see pushid-inspect --help"};
  }
  if (FLAGS_svg_out.empty() && FLAGS_json_out.empty()) return;
  if (FLAGS_wave) throw Error{"--wave writes no files; leave --svg_out and --json_out out"};
  for (const std::string& file : g_files) {
    OrFail(OutputFiles().CheckNotRead("the command line", file));
  }
  if (!FLAGS_svg_out.empty() && g_files.size() > 1) {
    throw Error{"--svg_out draws one file, not " + std::to_string(g_files.size())};
  }
  OrFail(CheckOutputFiles({FLAGS_svg_out, FLAGS_json_out}));
}

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

int Run() {
  CheckFlags();
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
    std::printf("%s", InspectionText(found.value()).c_str());
    all.push_back(InspectionJson(found.value()));
    if (FLAGS_svg_out.empty()) continue;
    const Inspection& seen = found.value();
    if (seen.hip.empty() && seen.seen.empty() && seen.forces.empty()) {
      return Fail(file + ": a " + seen.format +
                  " contains nothing to draw; give the file of a recording");
    }
    OrFail(WriteFileAtomically(FLAGS_svg_out, InspectionSvg(found.value())));
    std::printf("  picture         %s\n", FLAGS_svg_out.c_str());
  }
  if (FLAGS_json_out.empty()) return outcome;
  OrFail(WriteJson(FLAGS_json_out, all, 1));
  return outcome;
}

}  // namespace

int main(int argc, char** argv) {
  return pushid::RunApp(
      argc, argv,
      "pushid-inspect shows what files contain (BVH, C3D, TRC, STO, MOT, CSV, a manifest) and "
      "warns about units, axes, rate, gaps, jumps, standing height, start and onset.\n\n"
      "  pushid-inspect trial.c3d other.trc\n"
      "  pushid-inspect one/manifest.json,two/manifest.json\n"
      "  pushid-inspect table.csv --mapping=mapping.json\n"
      "  pushid-inspect trial.c3d --svg_out=trial.svg\n"
      "  pushid-inspect --wave crowd1.txt crowd2.txt",
      Run, &g_files);
}
