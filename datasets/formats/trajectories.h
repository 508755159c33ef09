// datasets: trajectories of crowds, one point a person, as text, and where people stand in a frame.
//
//   # framerate: 16.00
//   # id frame x/m y/m z/m
//   1 98 4.66 1.25 1.72
//
// or as CSV, where a header names the columns, in any order:
//   id,frame,time,x,y
//   1,98,6.125,4.66,1.25
//
// A person is a point named by the id. People come and go: frames in which one is lacking are not
// seen. Frame 0 of what is read is the first frame of the file. Lengths are metres unless the
// comments, or the header, say x/cm or "in cm" (mm alike); without a third coordinate z is 0. The
// rate comes from a comment, or from a column of times in s.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "datasets/formats/point_motion.h"

namespace pushid {

// Whether a CSV file's header names id, frame, x and y: trajectories, and no table of one person.
bool IsCrowdCsv(const std::string& path);

// Errors name the line: rows of other than 4 numbers or more (3 without z), ids and frames that are
// no whole numbers, a person twice in one frame, no framerate, more frames than fit into memory.
Result<PointMotion> ReadTrajectoryText(const std::string& path,
                                       const PointReadOptions& options = {});

// Writes atomically; positions are in m. Names that are whole numbers are the ids, otherwise people
// count from 0 and comments of the text give their names. A person has no row for a frame without
// them.
MaybeError WriteTrajectoryText(const std::string& path, const PointMotion& motion);

struct CrowdPlace {
  std::string name;          // the file's id
  Eigen::Vector2d position;  // m
};

// The file's own number of its first frame.
std::int64_t FirstFrame(const PointMotion& motion);

// Everybody seen in the frame, as the file numbers them, in the order of formations: from the
// smallest x forwards, and of one x from right to left. Without a frame, those of the first.
// Errors: no such frame, nobody in it.
Result<std::vector<CrowdPlace>> PlacesAt(const PointMotion& motion,
                                         std::optional<std::int64_t> frame);

// m; of everybody's distance to the nearest other, the median; 0 of one person.
double MedianSpacing(const std::vector<CrowdPlace>& places);

// A warning where people stand nearly at one place, or so far apart that the unit may be another;
// else empty.
std::string OddSpacing(const std::vector<CrowdPlace>& places);

}  // namespace pushid
