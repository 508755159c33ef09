// datasets: crowds, a point a person: where people stand in one frame of a file, and
// recordings as trajectories for PedPy and JuPedSim.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/formats/point_motion.h"
#include "datasets/manifest/recording.h"

namespace pushid {

struct CrowdPlace {
  std::string name;          // the file's id
  Eigen::Vector2d position;  // m
};

// The file's own number of its first frame.
std::int64_t FirstFrame(const PointMotion& motion);

// Everybody seen in the frame, as the file numbers them, in the order of formations: from the
// smallest x forwards, and of one x from right to left. Errors: no such frame, nobody in it.
Result<std::vector<CrowdPlace>> PlacesAt(const PointMotion& motion, std::int64_t frame);

// m; of everybody's distance to the nearest other, the median; 0 of one person.
double MedianSpacing(const std::vector<CrowdPlace>& places);

// What is odd about the places: people nearly at one, or so far apart that the unit may be another;
// empty: nothing.
std::string OddSpacing(const std::vector<CrowdPlace>& places);
inline constexpr double kClosestPeople = 0.05;  // m

// Of a file of trajectories; without a frame those of its first. Errors besides those of the
// readers: a file of another kind.
Result<std::vector<CrowdPlace>> ReadCrowdPlaces(const std::string& path,
                                                std::optional<std::int64_t> frame);

// Recordings and runs as trajectories of a crowd, a hip a person, for PedPy and JuPedSim.

// Hips in m under the subjects' names; frames that do not count are not seen.
PointMotion HipTrajectories(const Recording& recording);

// By the file's ending: .txt or .sqlite.
MaybeError WriteTrajectories(const std::string& path, const PointMotion& motion);

// An Error where the ending is another one.
MaybeError CheckTrajectoryFile(const std::string& flag, const std::string& path);

}  // namespace pushid
