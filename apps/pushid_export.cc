// apps: pushid-export: recordings in the formats of other programs.
#include <cstdio>
#include <system_error>

#include "apps/flags/command_line.h"
#include "apps/flags/export_flags.h"
#include "apps/flags/overwrite_flag.h"
#include "apps/flags/recording_flags.h"
#include "datasets/exchange/bids_dataset.h"
#include "datasets/exchange/crowd.h"
#include "datasets/files/atomic_file.h"

namespace {

using namespace pushid;

// Which files there will be, before any is written.
Result<std::vector<std::string>> TrajectoryFiles(const ExportFlags& flags,
                                                 const std::vector<Recording>& recordings) {
  const bool sqlite = flags.format == ExportFormat::kTrajectorySqlite;
  std::vector<std::string> files;
  for (const Recording& recording : recordings) {
    files.push_back(flags.folder + "/" + recording.id + (sqlite ? ".sqlite" : ".txt"));
    if (MaybeError error = CheckNew("out", files.back())) return *error;
  }
  return files;
}

MaybeError ExportTrajectories(const ExportFlags& flags, const std::vector<Recording>& recordings) {
  const Result<std::vector<std::string>> files = TrajectoryFiles(flags, recordings);
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
  const Result<ExportFlags> flags = ExportFlagsFromCommandLine();
  if (!flags.ok()) return Fail(flags.error());
  const bool bids = flags.value().format == ExportFormat::kBids;
  const Result<std::vector<Recording>> recordings = LoadFlaggedRecordings({}, bids);
  if (!recordings.ok()) return Fail(recordings.error());
  const std::string& folder = flags.value().folder;
  const MaybeError error = bids ? WriteBidsDataset(folder, recordings.value(), Version())
                                : ExportTrajectories(flags.value(), recordings.value());
  if (error) return Fail(*error);
  std::printf("%zu recordings written to %s%s\n", recordings.value().size(), folder.c_str(),
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
