// datasets: one person of a recording from the file that holds their motion.
#pragma once

#include <string>
#include <vector>

#include "datasets/loading/load_recordings.h"

namespace pushid {

struct LoadedPerson {
  RecordedPerson person;
  double fps = 0.0;       // the manifest's, otherwise the file's
  std::string file_hash;  // of the file (and of the mapping, where there is one)
};

// Reads the file of subject `index`, cuts it to the manifest's frames, closes gaps, turns it to the
// project's units and axes and checks that it can be a person.
Result<LoadedPerson> LoadPerson(const Manifest& manifest, const ManifestRecording& entry,
                                std::size_t index, const LoadOptions& options,
                                std::vector<std::string>* warnings);

}  // namespace pushid
