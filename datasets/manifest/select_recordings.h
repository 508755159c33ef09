// datasets: which recordings a run uses, of one manifest or of several.
#pragma once

#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/manifest/manifest.h"

namespace pushid {

// Indices into manifest.recordings, in the manifest's order.
//
// `setting` as --setting spells it: "all", or a comma-separated list of the manifest's settings and
// "groups" (recordings of more than one person). `ids`: only these; empty: no restriction.
// `leave_out`: not these of them. A setting or id that does not exist is an Error that lists what
// does.
Result<std::vector<int>> SelectRecordings(const Manifest& manifest, const std::string& setting,
                                          const std::vector<std::string>& ids,
                                          const std::vector<std::string>& leave_out = {});

// Several manifests as one, as --recordings=a.json,b.json names them.

// "a.json,b.json": each; a file whose own name has a comma stands for itself.
std::vector<std::string> ManifestPaths(const std::string& list);

// The recordings of all of them, in their order; a unit that stands beside `recordings` goes into
// its recordings. Errors besides those of ReadManifest: an id in two of them, a person of one mass
// here and of another there.
Result<Manifest> ReadManifests(const std::string& list);

// HashFile of the one, or a hash of their hashes.
Result<std::string> HashManifests(const std::string& list);

}  // namespace pushid
