// apps: pushid-export by flag.
#include "apps/flags/export_flags.h"

#include <gflags/gflags.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/flags/command_line.h"
#include "apps/flags/overwrite_flag.h"
#include "datasets/files/json_file.h"

DEFINE_string(out, "", "the folder to write");
DEFINE_string(format, "bids",
              "bids: a Motion-BIDS data set with all joints and pushes; txt or sqlite: one file "
              "per recording with everybody's hip, for PedPy and JuPedSim");

namespace pushid {
namespace {

Result<ExportFormat> Format() {
  if (FLAGS_format == "bids") return ExportFormat::kBids;
  if (FLAGS_format == "txt") return ExportFormat::kTrajectoryText;
  if (FLAGS_format == "sqlite") return ExportFormat::kTrajectorySqlite;
  return Error{"--format is '" + FLAGS_format + "'; it must be bids, txt or sqlite"};
}

// "GeneratedBy" of a data set of BIDS.
bool WrittenByPushid(const std::string& description) {
  const Result<nlohmann::json> about = ReadJson(description);
  if (!about.ok() || !about.value().is_object()) return false;
  const nlohmann::json programs = about.value().value("GeneratedBy", nlohmann::json::array());
  return std::any_of(programs.begin(), programs.end(), [](const nlohmann::json& program) {
    return program.is_object() && program.value("Name", nlohmann::json()) == "pushid";
  });
}

// A folder with data of other origin stays as it is, whatever --overwrite says.
MaybeError CheckFolder(const std::string& folder) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const std::string about = (fs::path(folder) / "dataset_description.json").string();
  if (WrittenByPushid(about)) return CheckNew("out", about);
  for (const char* name : {"dataset_description.json", "participants.tsv", "manifest.json"}) {
    const fs::path file = fs::path(folder) / name;
    if (!fs::exists(file, ignored)) continue;
    return Error{"is not an output of pushid-export and would be overwritten; choose another --out",
                 file.string()};
  }
  return std::nullopt;
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
