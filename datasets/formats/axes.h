// datasets: axes of a file turned to the project's: x forward, y left, z up.
#pragma once

#include <Eigen/Core>
#include <string>

#include "datasets/files/error.h"

namespace pushid {

// The rotation that takes a file's coordinates to the project's, from the file's axes that point up
// and forward ("z", "+x", "-y", upper or lower case). Its rows are forward, up x forward and up.
// Error (without a place): not an axis, or both along the same line.
Result<Eigen::Matrix3d> AxesRotation(const std::string& up, const std::string& forward);

}  // namespace pushid
