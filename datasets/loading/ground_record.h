// datasets: how the ground of a recording moved, frame by frame, from a file or from markers on it.
//
//   time,x,y,theta,phi
//   0.00,0.000,0.0,0.0,0.0
//   0.01,0.002,0.0,0.0,0.0
// x, y: m, or m/s, or m/s^2; theta and phi: tilt about y and about x as the pendulum's angles are,
// rad, or per s, or per s^2. Columns that lack are zero. Rates are summed up so that they are those
// by which a rollout steps (models/ground.h), from rest.
#pragma once

#include <vector>

#include "datasets/files/error.h"
#include "datasets/manifest/manifest.h"

namespace pushid {

// A platform moves at frame 0 where it is faster than this, m/s or rad/s: people would not be at
// rest.
inline constexpr double kGroundAtRest = 0.02;

// Poses at the recording's frames (its fps, its number of frames), counted from frame 0. Errors:
// those of the files, a record that ends early or begins late, ground that does not start at rest,
// markers that are not there or not seen.
Result<std::vector<GroundPose>> LoadGround(const ManifestRecording& entry,
                                           const Recording& recording);

}  // namespace pushid
