// apps: pushid-export by flag.
#pragma once

#include <string>

#include "datasets/files/error.h"

namespace pushid {

enum class ExportFormat { kBids, kTrajectoryText, kTrajectorySqlite };

struct ExportFlags {
  std::string folder;
  ExportFormat format = ExportFormat::kBids;
};
Result<ExportFlags> ExportFlagsFromCommandLine();

}  // namespace pushid
