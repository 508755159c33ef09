// datasets: folders that outputs need.
#include "datasets/files/folders.h"

#include <filesystem>

namespace pushid {

MaybeError MakeFolder(const std::string& folder) {
  std::error_code failed;
  if (!folder.empty()) std::filesystem::create_directories(folder, failed);
  if (failed) return Error{"cannot make this folder: " + failed.message(), folder};
  return std::nullopt;
}

MaybeError MakeFolderOf(const std::string& file) {
  return MakeFolder(std::filesystem::path(file).parent_path().string());
}

}  // namespace pushid
