// apps: --overwrite, for programs whose outputs a person may have edited or cannot make again.
#pragma once

#include "apps/flags/command_line.h"
#include "datasets/files/json_file.h"

DEFINE_bool(overwrite, false, "replace existing recordings, manifests, pushes and figures");

namespace pushid {

// An Error where the file is there and --overwrite is not given. flag names the file. besides: what
// else may be done ("; --update keeps ...").
inline MaybeError CheckNew(const std::string& flag, const std::string& file,
                           const std::string& besides = "") {
  std::error_code ignored;
  if (FLAGS_overwrite || !std::filesystem::exists(file, ignored)) return std::nullopt;
  throw Error{"already exists; --overwrite replaces it" + besides + "; or name another --" + flag,
              file};
}

// Checks a folder of recordings that pushid-simulate writes: --overwrite replaces only its
// earlier output, real recordings stay.
inline MaybeError CheckOutputFolder(const std::string& flag, const std::string& folder) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  if (!fs::exists(folder, ignored)) return std::nullopt;
  if (!fs::is_directory(folder, ignored)) {
    return Error{"--" + flag + " names " + folder + ", which is a file; name a folder"};
  }
  const std::string manifest = (fs::path(folder) / "manifest.json").string();
  if (!fs::exists(manifest, ignored)) return std::nullopt;
  const Result<JsonDocument> document = ReadJsonDocument(manifest);
  if (document.ok() && document.value().content.contains("synthetic")) {
    return CheckNew(flag, manifest);
  }
  return Error{
      "is not an output of pushid-simulate and would be overwritten; choose another --" + flag,
      manifest};
}

}  // namespace pushid
