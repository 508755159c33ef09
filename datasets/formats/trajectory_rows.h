// datasets: rows (person, frame, position) of trajectories gathered into points; shared by the
// formats of trajectories.h.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "datasets/formats/point_motion.h"

namespace pushid {

class TrajectoryRows {
 public:
  // false: the person has that frame already.
  bool Add(std::int64_t person, std::int64_t frame, const Eigen::Vector3d& position);

  // Sets names, chosen, positions and first_time_s (by rate_hz, which is set before). Errors: no
  // rows, more frames than fit into memory.
  MaybeError Fill(const PointReadOptions& options, PointMotion* motion) const;

 private:
  std::map<std::int64_t, std::map<std::int64_t, Eigen::Vector3d>> people_;
  std::int64_t first_ = 0, last_ = -1;
};

}  // namespace pushid
