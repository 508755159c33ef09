// apps: pushid-inspect: what files hold, and what about them will matter.
#include <cstdio>

#include "apps/flags/command_line.h"
#include "apps/flags/inspect_flags.h"
#include "datasets/files/atomic_file.h"
#include "datasets/inspection/inspection.h"
#include "ident/report/inspection_svg.h"

namespace {

using namespace pushid;

std::vector<std::string> g_files;

int Run() {
  const Result<InspectFlags> read = InspectFlagsFromCommandLine(g_files);
  if (!read.ok()) return Fail(read.error());
  const InspectFlags& flags = read.value();
  // A file that cannot be read does not keep the others from being told about.
  int outcome = kDone;
  for (const std::string& file : g_files) {
    const Result<Inspection> found = Inspect(file, flags.mapping);
    if (!found.ok()) {
      outcome = Fail(found.error());
      continue;
    }
    std::printf("%s", InspectionText(found.value()).c_str());
    if (flags.svg_out.empty()) continue;
    const Inspection& seen = found.value();
    if (seen.hip.empty() && seen.seen.empty() && seen.forces.empty()) {
      return Fail(file + ": a " + seen.format +
                  " contains nothing to draw; give the file of a recording");
    }
    if (MaybeError error = WriteFileAtomically(flags.svg_out, InspectionSvg(found.value()))) {
      return Fail(*error);
    }
    std::printf("  picture         %s\n", flags.svg_out.c_str());
  }
  return outcome;
}

}  // namespace

int main(int argc, char** argv) {
  return pushid::RunApp(
      argc, argv,
      "pushid-inspect shows what files contain (BVH, C3D, TRC, STO, MOT, CSV, a manifest) and "
      "warns about units, axes, rate, gaps, jumps, standing height, start and onset.\n\n"
      "  pushid-inspect trial.c3d other.trc\n"
      "  pushid-inspect table.csv --mapping=mapping.json\n"
      "  pushid-inspect trial.c3d --svg_out=trial.svg",
      Run, &g_files);
}
