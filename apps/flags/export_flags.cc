// apps: pushid-export by flag.
#include "apps/flags/export_flags.h"

#include <gflags/gflags.h>

#include <filesystem>

#include "apps/flags/command_line.h"
#include "apps/flags/overwrite_flag.h"

DEFINE_string(out, "", "the folder to write");
DEFINE_string(format, "bids",
              "bids: a data set of Motion-BIDS with everybody's joints and the pushes; txt or "
              "sqlite: a file a recording with everybody's hip, for PedPy and JuPedSim");

namespace pushid {
namespace {

Result<ExportFormat> Format() {
  if (FLAGS_format == "bids") return ExportFormat::kBids;
  if (FLAGS_format == "txt") return ExportFormat::kTrajectoryText;
  if (FLAGS_format == "sqlite") return ExportFormat::kTrajectorySqlite;
  return Error{"--format is '" + FLAGS_format + "'; it must be bids, txt or sqlite"};
}

// A folder with recordings of other origin stays as it is, whatever --overwrite says.
MaybeError CheckFolder(const std::string& folder) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const fs::path manifest = fs::path(folder) / "manifest.json";
  const fs::path about = fs::path(folder) / "dataset_description.json";
  if (fs::exists(manifest, ignored) && !fs::exists(about, ignored)) {
    return Error{"is no output of pushid-export and would be overwritten; name another --out",
                 manifest.string()};
  }
  return CheckNew("out", about.string());
}

}  // namespace

Result<ExportFlags> ExportFlagsFromCommandLine() {
  const Result<ExportFormat> format = Format();
  if (!format.ok()) return format.error();
  if (MaybeError missing = Require("out", FLAGS_out, "name the folder to write")) return *missing;
  if (format.value() == ExportFormat::kBids) {
    if (MaybeError error = CheckFolder(FLAGS_out)) return *error;
  }
  return ExportFlags{FLAGS_out, format.value()};
}

}  // namespace pushid
