// datasets: trajectories of crowds, one point a person: text as PedPy, JuPedSim and PeTrack write
// it, and JuPedSim's SQLite files.
//
//   # framerate: 16.00
//   # id frame x/m y/m z/m
//   1 98 4.66 1.25 1.72
//
// A person is a point named by the id. People come and go: frames in which one is lacking are not
// seen. Frame 0 of what is read is the first frame of the file. Lengths are metres unless the
// comments say x/cm or "in cm" (mm alike); without a third coordinate z is 0.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "datasets/formats/point_motion.h"

namespace pushid {

// Errors name the line: rows of other than 4 numbers or more (3 without z), ids and frames that are
// no whole numbers, a person twice in one frame, no framerate.
Result<PointMotion> ReadTrajectoryText(const std::string& path,
                                       const PointReadOptions& options = {});

// Tables trajectory_data and metadata (versions 1 and 2). Errors: no SQLite file, no such tables,
// no fps.
Result<PointMotion> ReadTrajectorySqlite(const std::string& path,
                                         const PointReadOptions& options = {});

// Atomically; positions in m. Names that are whole numbers are the ids, otherwise people count from
// 1 and comments of the text give their names. A person has no row for a frame without them.
MaybeError WriteTrajectoryText(const std::string& path, const PointMotion& motion);

// Version 2. Everybody faces forward, +x; the walkable area is a rectangle with a margin
// of 1 m around all positions.
MaybeError WriteTrajectorySqlite(const std::string& path, const PointMotion& motion);

// The ids that are written for the points.
std::vector<std::int64_t> TrajectoryIds(const std::vector<std::string>& names);

// Rows (person, frame, position) of trajectories gathered into points; shared by the
// formats of trajectories.h.

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
