// apps: warnings about many recordings on stderr.
#pragma once

#include <string>
#include <vector>

#include "apps/support/app_support.h"
#include "datasets/loading/load_recordings.h"

namespace pushid {

// Those that differ only in the recording as one.
inline void WarnGrouped(const std::vector<std::string>& messages) {
  for (const std::string& message : GroupedWarnings(messages)) Warn(message);
}

}  // namespace pushid
