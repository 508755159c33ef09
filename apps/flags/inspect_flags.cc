// apps: pushid-inspect by flag.
#include "apps/flags/inspect_flags.h"

#include <gflags/gflags.h>

#include "apps/flags/command_line.h"
#include "apps/support/overwrite_check.h"

DEFINE_string(mapping, "", "mapping file: which columns or joints are hip and ankles, time, rate");
DEFINE_string(svg_out, "", "draw hip, gaps and forces here (SVG); for one file");

namespace pushid {

Result<InspectFlags> InspectFlagsFromCommandLine(const std::vector<std::string>& files) {
  if (files.empty()) {
    return Error{"name one or more files to inspect; see pushid-inspect --help"};
  }
  InspectFlags flags;
  flags.svg_out = FLAGS_svg_out;
  if (!flags.svg_out.empty()) {
    if (files.size() > 1) {
      return Error{"--svg_out draws one file, not " + std::to_string(files.size())};
    }
    if (MaybeError error = OutputFiles().CheckNotRead("the command line", files[0])) return *error;
    if (MaybeError error = CheckOutputFiles({flags.svg_out})) return *error;
  }
  if (FLAGS_mapping.empty()) return flags;
  Result<ColumnMapping> mapping = ReadColumnMapping(FLAGS_mapping);
  if (!mapping.ok()) return mapping.error();
  flags.mapping = std::move(mapping.value());
  return flags;
}

}  // namespace pushid
