// apps: what may be overwritten.
#include "apps/support/output_folder.h"

#include <filesystem>

#include "datasets/files/json_file.h"

namespace pushid {

MaybeError CheckOutputFolder(const std::string& flag, const std::string& folder) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  if (!fs::exists(folder, ignored)) return std::nullopt;
  if (!fs::is_directory(folder, ignored)) {
    return Error{"--" + flag + " names " + folder + ", which is a file; name a folder"};
  }
  const std::string manifest = (fs::path(folder) / "manifest.json").string();
  if (!fs::exists(manifest, ignored)) return std::nullopt;
  const Result<JsonDocument> document = ReadJsonDocument(manifest);
  if (document.ok() && document.value().content.contains("synthetic")) return std::nullopt;
  return Error{"is no output of pushid-simulate and would be overwritten; name another --" + flag,
               manifest};
}

}  // namespace pushid
