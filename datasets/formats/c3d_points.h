// datasets: the points of a C3D file.
#pragma once

#include <string>

#include "datasets/formats/point_motion.h"

namespace pushid {

// Errors are those of ReadC3d (c3d.h).
Result<PointMotion> ReadC3dPoints(const std::string& path, const PointReadOptions& options = {});

}  // namespace pushid
