// apps: folders that pushid-simulate writes recordings into.
#pragma once

#include <string>

#include "datasets/files/error.h"

namespace pushid {

// Earlier output of pushid-simulate may be replaced; real recordings may not. flag: the
// one that names the folder, for messages.
MaybeError CheckOutputFolder(const std::string& flag, const std::string& folder);

}  // namespace pushid
