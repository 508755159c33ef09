// datasets: keys of a manifest's recording that are most likely misspelt.
#pragma once

#include <string>
#include <vector>

#include "datasets/manifest/manifest.h"

namespace pushid {

// Of a recording, known to this program.
const std::vector<std::string>& ManifestKeys();

// "has the key 'push_scv', which is not known and not used; is push_csv meant?" for each. Keys that
// are like no known one are a user's own, and fine.
std::vector<std::string> MisspeltKeys(const ManifestRecording& entry);

}  // namespace pushid
