// datasets: what is done to a motion between the file and the fit, and whether it can be a
// person at all.
#pragma once

#include "datasets/files/error.h"
#include "datasets/formats/units.h"
#include "datasets/manifest/recording.h"

namespace pushid {

struct PreparationOptions {
  // Gaps of up to this long are interpolated; frames of longer ones get weight 0. 0: none is.
  double max_gap_s = 0.1;
  // Zero-phase low-pass of all positions (tracks.h), Hz; 0: none. 6 to 10 Hz is usual for trunk
  // and ankles; it also rounds off the first frames of the reaction to a push.
  double lowpass_hz = 0.0;
  // The rate at which the motion is rolled out and compared, frames per second; 0: the recording's.
  // Lower rates make fits cheaper and the discretization coarser.
  double resample_fps = 0.0;
};

// What is wrong with the options, if anything.
MaybeError CheckPreparation(const PreparationOptions& options);

// Filters and resamples a recording whose gaps are filled. Errors: a cut-off that the recording's
// rate cannot have, a lower rate without a low-pass of at most half of it, fewer than three frames
// left.
MaybeError PrepareMotion(const PreparationOptions& options, Recording* recording);

// Whether positions read from a file can be a person at all. Wrong units and wrong axes
// fit happily and give nonsense, so they are caught here.

// Looks at the distance from the ankles' midpoint to the hip at frame 0 (in people about 0.7 to 1.1
// m; accepted are 0.12 to 3 m), at its direction (within 1 rad of up) and at every position (within
// 100 km of the origin, three frames at least). `unit` is what the file was read in.
MaybeError CheckMotion(const RecordedPerson& person, double metres_per_unit);

}  // namespace pushid
