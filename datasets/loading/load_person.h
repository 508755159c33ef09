// datasets: one person of a recording from the file that holds their motion.
#pragma once

#include <string>
#include <vector>

#include "datasets/loading/load_recordings.h"

namespace pushid {

// Reads the file of subject `index`, cuts it to the manifest's frames, closes gaps, turns it to the
// project's units and axes and checks that it can be a person. *file_hash: of the file (and of the
// mapping, where there is one).
Result<RecordedPerson> LoadPerson(const Manifest& manifest, const ManifestRecording& entry,
                                  std::size_t index, const LoadOptions& options,
                                  std::string* file_hash, std::vector<std::string>* warnings);

}  // namespace pushid
