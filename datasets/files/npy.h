// datasets: numbers in NumPy's .npy format (version 1.0, little-endian float32, one dimension), so
// that weights read in any language: numpy.load("weights.npy").
#pragma once

#include <string>
#include <vector>

#include "datasets/files/error.h"

namespace pushid {

// Writes atomically.
MaybeError WriteNpy(const std::string& path, const std::vector<float>& values);

// Errors: no .npy file, another type, order or number of dimensions, cut off.
Result<std::vector<float>> ReadNpy(const std::string& path);

// The bytes of such a file.
std::string NpyBytes(const std::vector<float>& values);

}  // namespace pushid
