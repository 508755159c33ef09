// apps: pushid-export: recordings in the formats of other programs.
#include <gflags/gflags.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <system_error>

#include "apps/flags/command_line.h"
#include "apps/flags/recording_flags.h"
#include "datasets/exchange/bids_dataset.h"
#include "datasets/exchange/crowd.h"
#include "datasets/files/atomic_file.h"
#include "datasets/files/error.h"
#include "datasets/files/json_file.h"
#include "datasets/formats/motion_formats.h"

DEFINE_string(out, "", "the folder to write");
DEFINE_string(format, "bids",
              "bids: a Motion-BIDS data set with all joints and pushes; txt or sqlite: one file "
              "per recording with everybody's hip, for PedPy and JuPedSim");

namespace {

using namespace pushid;
// Of the files, one per recording; nullopt: a data set of Motion-BIDS.
Result<std::optional<MotionFormat>> CrowdFormat() {
  if (FLAGS_format == "bids") return std::optional<MotionFormat>();
  const std::optional<MotionFormat> format = FromName<MotionFormat>(FLAGS_format);
  if (format && HoldsCrowd(*format)) return format;
  const auto is_crowd = [](const MotionFormatRow& row) { return HoldsCrowd(row.value); };
  return Error{"--format is '" + FLAGS_format + "'; it must be bids, " +
               AnyName<MotionFormat>(is_crowd)};
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

// That of --format, once all flags have been checked.
Result<std::optional<MotionFormat>> CheckedFormat() {
  const Result<std::optional<MotionFormat>> format = CrowdFormat();
  if (!format.ok()) return format.error();
  if (MaybeError missing = Require("out", FLAGS_out, "name the folder to write")) return *missing;
  if (!format.value()) {
    if (MaybeError error = CheckFolder(FLAGS_out)) return *error;
  }
  return format;
}

// Which files there will be, before any is written.
Result<std::vector<std::string>> TrajectoryFiles(MotionFormat format,
                                                 const std::vector<Recording>& recordings) {
  std::vector<std::string> files;
  for (const Recording& recording : recordings) {
    files.push_back(FLAGS_out + "/" + recording.id + "." + NameOf(format));
    if (MaybeError error = CheckNew("out", files.back())) return *error;
  }
  return files;
}

MaybeError ExportTrajectories(MotionFormat format, const std::vector<Recording>& recordings) {
  const Result<std::vector<std::string>> files = TrajectoryFiles(format, recordings);
  if (!files.ok()) return files.error();
  for (size_t i = 0; i < recordings.size(); ++i) {
    if (MaybeError error = MakeFolderOf(files.value()[i])) return error;
    if (MaybeError error = WriteTrajectories(files.value()[i], HipTrajectories(recordings[i]))) {
      return error;
    }
  }
  return std::nullopt;
}

int Run() {
  const Result<std::optional<MotionFormat>> format = CheckedFormat();
  if (!format.ok()) return Fail(format.error());
  const bool bids = !format.value();
  const Result<std::vector<Recording>> recordings = LoadFlaggedRecordings({}, bids);
  if (!recordings.ok()) return Fail(recordings.error());
  const MaybeError error = bids ? WriteBidsDataset(FLAGS_out, recordings.value(), Version())
                                : ExportTrajectories(*format.value(), recordings.value());
  if (error) return Fail(*error);
  std::printf("%zu recordings written to %s%s\n", recordings.value().size(), FLAGS_out.c_str(),
              bids ? "; --recordings with its manifest.json reads them again"
                   : ": everybody's hip, without pushes and masses");
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  return RunApp(argc, argv,
                "pushid-export writes recordings for other programs.\n\n"
                "  pushid-export --recordings=M/manifest.json --setting=groups --out=pushes_bids\n"
                "  pushid-export --recordings=M/manifest.json --setting=groups --format=txt "
                "--out=trajectories",
                Run);
}
