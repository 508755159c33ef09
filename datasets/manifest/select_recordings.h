// datasets: which of a manifest's recordings a run uses.
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

}  // namespace pushid
