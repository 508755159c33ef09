// apps: pushid-generate on motion capture: windows of clips forecast, judged and shown.
#pragma once

#include "apps/flags/generate_flags.h"

namespace pushid {

// Returns the exit code.
int GenerateFromClips(const LoadedGenerator& loaded, const GenerateFlags& flags);

}  // namespace pushid
