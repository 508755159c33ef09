// datasets: where people of a crowd stand in one frame of its trajectories.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/formats/point_motion.h"

namespace pushid {

struct CrowdPlace {
  std::string name;          // the file's id
  Eigen::Vector2d position;  // m
};

// Everybody seen in the frame, counted from the file's first, in the order of formations: from the
// smallest x forwards, and of one x from right to left. Errors: no such frame, nobody in it.
Result<std::vector<CrowdPlace>> PlacesAt(const PointMotion& motion, int frame);

// Of a file of trajectories. Errors besides those of the readers: a file of another kind.
Result<std::vector<CrowdPlace>> ReadCrowdPlaces(const std::string& path, int frame);

}  // namespace pushid
