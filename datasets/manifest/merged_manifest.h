// datasets: several manifests as one, as --recordings=a.json,b.json names them.
#pragma once

#include <string>
#include <vector>

#include "datasets/manifest/manifest.h"

namespace pushid {

// "a.json,b.json": each; a file whose own name has a comma stands for itself.
std::vector<std::string> ManifestPaths(const std::string& list);

// The recordings of all of them, in their order; a unit that stands beside `recordings` goes into
// its recordings. Errors besides those of ReadManifest: an id in two of them, a person of one mass
// here and of another there.
Result<Manifest> ReadManifests(const std::string& list);

// HashFile of the one, or a hash of their hashes.
Result<std::string> HashManifests(const std::string& list);

}  // namespace pushid
