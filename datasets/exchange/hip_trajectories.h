// datasets: recordings and runs as trajectories of a crowd, a hip a person, for PedPy and JuPedSim.
#pragma once

#include <string>

#include "datasets/files/error.h"
#include "datasets/formats/point_motion.h"
#include "datasets/manifest/recording.h"

namespace pushid {

// Hips in m under the subjects' names; frames that do not count are not seen.
PointMotion HipTrajectories(const Recording& recording);

// By the file's ending: .txt or .sqlite.
MaybeError WriteTrajectories(const std::string& path, const PointMotion& motion);

// An Error where the ending is another one.
MaybeError CheckTrajectoryFile(const std::string& flag, const std::string& path);

}  // namespace pushid
