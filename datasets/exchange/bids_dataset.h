// datasets: recordings as a data set of Motion-BIDS, to publish and to keep.
#pragma once

#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/manifest/recording.h"

namespace pushid {

// Of the people of a folder: dataset_description.json, README, participants.tsv and .json, for each
// person sub-LABEL/motion/sub-LABEL_task-push_tracksys-body_acq-RECORDING_motion.tsv with its
// sidecars, pushes in its channels; and manifest.json (in .bidsignore), by which pushid reads all
// of it again. Positions in m, x forward, y left, z up. Labels are the names without what is no
// letter or digit. recordings: with all joints. version: of the program. Errors: names that become
// one label, folders that cannot be made.
MaybeError WriteBidsDataset(const std::string& folder, const std::vector<Recording>& recordings,
                            const std::string& version);

}  // namespace pushid
