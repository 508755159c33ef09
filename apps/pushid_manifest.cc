// apps: pushid-manifest: a manifest from a folder and a naming pattern.
#include <cstdio>
#include <string>
#include <vector>

#include "apps/flags/command_line.h"
#include "apps/flags/manifest_flags.h"
#include "apps/support/overwrite_check.h"

namespace {

using namespace pushid;

// No flag names the files that the patterns find.
MaybeError CheckFilesKept(const Manifest& manifest, const std::string& path) {
  for (const ManifestRecording& recording : manifest.recordings) {
    std::vector<std::string> files = recording.motion;
    files.push_back(recording.push_csv);
    for (const std::string& file : files) {
      if (file.empty()) continue;
      if (MaybeError error = CheckNoOutput("--folder", ResolvePath(path, file))) return error;
    }
  }
  return std::nullopt;
}

int Run() {
  const Result<ManifestOptions> options = ManifestOptionsFromCommandLine();
  if (!options.ok()) return Fail(options.error());
  const std::string& path = options.value().manifest_path;
  const Result<MadeManifest> made = MakeManifest(options.value());
  if (!made.ok()) return Fail(made.error());
  if (MaybeError error = CheckFilesKept(made.value().manifest, path)) return Fail(*error);
  if (MaybeError error = WriteManifest(path, made.value().manifest)) return Fail(*error);
  for (const std::string& warning : made.value().warnings) Warn(warning);
  for (const Error& error : made.value().unreadable) Warn("left out: " + error.ToString());
  for (const std::string& id : made.value().without_push) Warn("recording " + id + " has no push");
  std::printf("%zu recordings from %d files (%d others in the folder) written to %s\n",
              made.value().manifest.recordings.size(), made.value().files, made.value().others,
              path.c_str());
  std::printf("look at them with: pushid-inspect %s\n", path.c_str());
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  return pushid::RunApp(
      argc, argv,
      "pushid-manifest makes the manifest of recordings whose file names follow a pattern.\n\n  "
      "pushid-manifest --folder=data --pattern='{setting}/{subject}_{magnitude}_{take}.c3d' "
      "--push_pattern='push/{subject}_{take}.csv' --masses=masses.csv --out=data/manifest.json",
      Run);
}
