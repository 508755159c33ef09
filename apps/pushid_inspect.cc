// apps: pushid-inspect: what files hold, and what about them will matter.
#include <gflags/gflags.h>

#include <cstdio>

#include "apps/support/app_support.h"
#include "apps/support/overwrite_check.h"
#include "datasets/files/atomic_file.h"
#include "datasets/inspection/inspection.h"
#include "ident/report/inspection_svg.h"

DEFINE_string(mapping, "", "mapping file: which columns or joints are hip and ankles, time, rate");
DEFINE_string(svg_out, "", "draw hip, gaps and forces here (SVG); for one file");

namespace {

using namespace pushid;

std::vector<std::string> g_files;

int Run() {
  if (g_files.empty()) return Fail("name one or more files to look at; see pushid-inspect --help");
  if (!FLAGS_svg_out.empty()) {
    if (g_files.size() > 1) {
      return Fail("--svg_out draws one file, not " + std::to_string(g_files.size()));
    }
    if (MaybeError error = CheckNoOutput("the command line", g_files[0])) return Fail(*error);
    if (MaybeError error = CheckWritable(FLAGS_svg_out)) return Fail(*error);
  }
  ColumnMapping mapping;
  if (!FLAGS_mapping.empty()) {
    Result<ColumnMapping> read = ReadColumnMapping(FLAGS_mapping);
    if (!read.ok()) return Fail(read.error());
    mapping = std::move(read.value());
  }
  // A file that cannot be read does not keep the others from being told about.
  int outcome = kDone;
  for (const std::string& file : g_files) {
    const Result<Inspection> found = Inspect(file, mapping);
    if (!found.ok()) {
      outcome = Fail(found.error());
      continue;
    }
    std::printf("%s", InspectionText(found.value()).c_str());
    if (FLAGS_svg_out.empty()) continue;
    const Inspection& seen = found.value();
    if (seen.hip.empty() && seen.seen.empty() && seen.forces.empty()) {
      return Fail(file + ": a " + seen.format + " has nothing to draw; name a recording's file");
    }
    if (MaybeError error = WriteFileAtomically(FLAGS_svg_out, InspectionSvg(found.value()))) {
      return Fail(*error);
    }
    std::printf("  drawn in        %s\n", FLAGS_svg_out.c_str());
  }
  return outcome;
}

}  // namespace

int main(int argc, char** argv) {
  return pushid::RunApp(
      argc, argv,
      "pushid-inspect tells what files hold (BVH, C3D, TRC, STO, MOT, CSV, a manifest) and warns "
      "of "
      "what will matter: units, axes, rate, gaps, jumps, standing height, start, onset.\n\n  "
      "pushid-inspect trial.c3d other.trc\n  pushid-inspect table.csv --mapping=mapping.json\n  "
      "pushid-inspect trial.c3d --svg_out=trial.svg",
      Run, &g_files);
}
