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
std::optional<MotionFormat> CrowdFormat() {
  if (FLAGS_format == "bids") return std::nullopt;
  const std::optional<MotionFormat> format = FromName<MotionFormat>(FLAGS_format);
  if (format && HoldsCrowd(*format)) return format;
  const auto is_crowd = [](const MotionFormatRow& row) { return HoldsCrowd(row.value); };
  throw Error{"--format is '" + FLAGS_format + "'; it must be bids, " +
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
void CheckFolder(const std::string& folder) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const std::string about = (fs::path(folder) / "dataset_description.json").string();
  if (WrittenByPushid(about)) return OrFail(CheckNew("out", about));
  for (const char* name : {"dataset_description.json", "participants.tsv", "manifest.json"}) {
    const fs::path file = fs::path(folder) / name;
    if (!fs::exists(file, ignored)) continue;
    throw Error{"is not an output of pushid-export and would be overwritten; choose another --out",
                file.string()};
  }
}

// That of --format, once all flags have been checked.
std::optional<MotionFormat> CheckedFormat() {
  const std::optional<MotionFormat> format = CrowdFormat();
  Require("out", FLAGS_out, "name the folder to write");
  if (!format) CheckFolder(FLAGS_out);
  return format;
}

// Which files there will be, before any is written.
std::vector<std::string> TrajectoryFiles(MotionFormat format,
                                         const std::vector<Recording>& recordings) {
  std::vector<std::string> files;
  for (const Recording& recording : recordings) {
    files.push_back(FLAGS_out + "/" + recording.id + "." + NameOf(format));
    OrFail(CheckNew("out", files.back()));
  }
  return files;
}

void ExportTrajectories(MotionFormat format, const std::vector<Recording>& recordings) {
  const std::vector<std::string> files = TrajectoryFiles(format, recordings);
  for (size_t i = 0; i < recordings.size(); ++i) {
    OrFail(MakeFolderOf(files[i]));
    OrFail(WriteTrajectories(files[i], HipTrajectories(recordings[i])));
  }
}

int Run() {
  const std::optional<MotionFormat> format = CheckedFormat();
  const bool bids = !format;
  const std::vector<Recording> recordings = LoadFlaggedRecordings({}, bids);
  if (bids) {
    OrFail(WriteBidsDataset(FLAGS_out, recordings, Version()));
  } else {
    ExportTrajectories(*format, recordings);
  }
  std::printf("%zu recordings written to %s%s\n", recordings.size(), FLAGS_out.c_str(),
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
