// datasets: a push as a CSV file.
//
//   frame,fx,fy,ftheta,fphi
//   0,145.18,-115.38,101.0,121.19
//   1,136.54,-21.54,92.83,27.64
//
// Row t is the generalized force [fx N, fy N, ftheta N m, fphi N m], in the project's axes (x
// forward, y left, z up), that drives the step from the push's frame t to t + 1. Rows count 0, 1,
// 2, ... without gaps.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "datasets/files/error.h"

namespace pushid {

// Errors name the line: wrong header, a row number out of sequence, too few or many fields, a field
// that is not a finite number, no rows at all.
Result<std::vector<Eigen::Vector4d>> ReadPushCsv(const std::string& path);

// Writes atomically; numbers are the shortest that read back to the same double.
MaybeError WritePushCsv(const std::string& path, const std::vector<Eigen::Vector4d>& force);

}  // namespace pushid
