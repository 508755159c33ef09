// datasets: folders that outputs need.
#pragma once

#include <string>

#include "datasets/files/error.h"

namespace pushid {

// With all folders above it; one that is there already is no error.
MaybeError MakeFolder(const std::string& folder);

// The folder in which a file is to be written.
MaybeError MakeFolderOf(const std::string& file);

}  // namespace pushid
