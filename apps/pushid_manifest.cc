// apps: pushid-manifest: a manifest from a folder and a naming pattern.
#include <cstdio>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "apps/flags/command_line.h"
#include "apps/flags/manifest_flags.h"
#include "apps/support/overwrite_check.h"
#include "datasets/files/names.h"

namespace {

using namespace pushid;

// No flag names the files that the patterns find.
MaybeError CheckFilesKept(const Manifest& manifest, const std::string& path) {
  const OutputFiles outputs;
  for (const ManifestRecording& recording : manifest.recordings) {
    std::vector<std::string> files = recording.motion;
    files.push_back(recording.push_csv);
    for (const std::string& file : files) {
      if (file.empty()) continue;
      const MaybeError error = outputs.CheckNotRead("--folder", ResolvePath(path, file));
      if (error) return error;
    }
  }
  return std::nullopt;
}

void PrintIds(const char* what, const std::vector<std::string>& ids) {
  if (!ids.empty()) std::printf("%s: %s\n", what, ListOfNames(ids).c_str());
}

// What the folder has and the manifest that is there has not, behind its entries; those stay as
// somebody may have edited them.
Result<Manifest> Updated(const std::string& path, const std::vector<ManifestRecording>& found) {
  std::error_code ignored;
  Manifest manifest;
  if (std::filesystem::exists(path, ignored)) {
    Result<Manifest> read = ReadManifest(path);
    if (!read.ok()) return read;
    manifest = std::move(read.value());
  }
  std::set<std::string> known, in_folder;
  for (const ManifestRecording& entry : manifest.recordings) known.insert(entry.id);
  std::vector<std::string> added, gone;
  for (const ManifestRecording& entry : found) {
    in_folder.insert(entry.id);
    if (known.count(entry.id) > 0) continue;
    added.push_back(entry.id);
    manifest.recordings.push_back(entry);
  }
  for (const std::string& id : known) {
    if (in_folder.count(id) == 0) gone.push_back(id);
  }
  std::printf("%zu recordings kept as they were, %zu added\n", known.size(), added.size());
  PrintIds("added", added);
  PrintIds("kept, although they do not match the pattern", gone);
  return manifest;
}

int Run() {
  const Result<ManifestFlags> flags = ManifestFlagsFromCommandLine();
  if (!flags.ok()) return Fail(flags.error());
  const std::string& path = flags.value().options.manifest_path;
  const Result<MadeManifest> made = MakeManifest(flags.value().options);
  if (!made.ok()) return Fail(made.error());
  Manifest manifest = made.value().manifest;
  if (MaybeError error = CheckFilesKept(manifest, path)) return Fail(*error);
  if (flags.value().update) {
    Result<Manifest> updated = Updated(path, manifest.recordings);
    if (!updated.ok()) return Fail(updated.error());
    manifest = std::move(updated.value());
  }
  if (MaybeError error = WriteManifest(path, manifest)) return Fail(*error);
  for (const std::string& warning : made.value().warnings) Warn(warning);
  for (const Error& error : made.value().unreadable) Warn("left out: " + error.ToString());
  for (const std::string& id : made.value().without_push) Warn("recording " + id + " has no push");
  std::printf("%zu recordings from %d files (%d others in the folder) written to %s\n",
              manifest.recordings.size(), made.value().files, made.value().others, path.c_str());
  std::printf("check them with: pushid-inspect %s\n", path.c_str());
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  return pushid::RunApp(
      argc, argv,
      "pushid-manifest writes the manifest of recordings whose file names follow a pattern.\n\n"
      "  pushid-manifest --folder=data --pattern='{setting}/{subject}_{magnitude}_{take}.c3d' "
      "--push_pattern='push/{subject}_{take}.csv' --masses=masses.csv --out=data/manifest.json",
      Run);
}
