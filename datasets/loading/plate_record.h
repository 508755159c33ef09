// datasets: what force platforms under a person measured, at the frames of the motion.
//
// C3D: platforms of the types of sensors/force_platform.h. Tables: columns that end with fx, fy, fz
// (vx, vy, vz in OpenSim's) and px, py (and pz, which is not needed), for each platform behind a
// prefix of its own:
//   time,fx,fy,fz,px,py             time,left_fx,...,left_py,right_fx,...,right_py
//   time,fx,fy,fz,mx,my,mz          N m about the entry's `origin`, instead of a centre
// N on the person (with moments also on the platform, which can only be pressed), m, in the axes
// that are said. Forces of several platforms add up, and their
// moments do. Low-passed without delay below half the frame rate before frames are taken.
#pragma once

#include <string>

#include "datasets/files/error.h"
#include "datasets/manifest/manifest.h"

namespace pushid {

inline constexpr double kWeightTolerance = 0.05;  // of the mean vertical force about m g
inline constexpr double kFarFromFeet = 0.6;       // m, of the centre of pressure

// Whether who stands on the platforms of `file` weighs what these measure, and stands nearest to
// where they are pressed.
MaybeError CheckPlates(const std::string& file, const Recording& recording, int person);

// Into the person's `plates`. Errors: those of the files, no such platform or column, a record that
// ends early, a mean vertical force that is not the weight, a centre of pressure off the platform
// or far from the feet.
MaybeError LoadPlates(const ManifestRecording& entry, const ManifestPlates& plates,
                      double lowpass_hz, Recording* recording);

}  // namespace pushid
