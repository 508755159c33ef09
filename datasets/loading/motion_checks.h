// datasets: whether positions read from a file can be a person at all. Wrong units and wrong axes
// fit happily and give nonsense, so they are caught here.
#pragma once

#include "datasets/files/error.h"
#include "datasets/formats/length_unit.h"
#include "datasets/manifest/recording.h"

namespace pushid {

// Looks at the distance from the ankles' midpoint to the hip at frame 0 (in people about 0.7 to 1.1
// m; accepted are 0.12 to 3 m), at its direction (within 1 rad of up) and at every position (within
// 100 km of the origin, three frames at least). `unit` is what the file was read in.
MaybeError CheckMotion(const RecordedPerson& person, double metres_per_unit);

}  // namespace pushid
