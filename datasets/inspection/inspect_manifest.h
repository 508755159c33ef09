// datasets: what a manifest lists, and which of it can be read.
#pragma once

#include "datasets/inspection/inspection.h"

namespace pushid {

// Adds facts about the manifest at inspection->path, and a warning for every recording that cannot
// be read and everything unusual about the others.
MaybeError InspectManifest(Inspection* inspection);

}  // namespace pushid
