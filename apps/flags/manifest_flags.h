// apps: the flags of pushid-manifest.
#pragma once

#include "datasets/inspection/manifest_maker.h"

namespace pushid {

struct ManifestFlags {
  ManifestOptions options;  // manifest_path is where --out says
  bool update = false;      // add to what is there
};
Result<ManifestFlags> ManifestFlagsFromCommandLine();

}  // namespace pushid
