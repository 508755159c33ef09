// apps: the flags of pushid-manifest.
#pragma once

#include "datasets/inspection/manifest_maker.h"

namespace pushid {

// manifest_path is where --out says.
Result<ManifestOptions> ManifestOptionsFromCommandLine();

}  // namespace pushid
