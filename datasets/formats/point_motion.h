// datasets: trajectories of named points (markers, joints of a skeleton or people of a crowd) from
// files of all formats: BVH, C3D, TRC, tables (CSV, OpenSim STO and MOT) with three columns per
// point, trajectories of crowds.
//
//   Result<PointMotion> motion = ReadTrc("trial.trc");  // any format: motion_formats.h
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/files/numeric_table.h"
#include "datasets/formats/units.h"

namespace pushid {

struct BvhSkeleton;

struct PointMotion {
  std::string path;
  double rate_hz = 0.0;            // frames per second; 0 when the file does not say
  double first_time_s = 0.0;       // of a table with times; C3D files count from their first frame
  std::optional<LengthUnit> unit;  // as the file says
  std::string unit_text;           // what the file says, when it is no unit known here
  std::string up;                  // the axis the file calls up, "+z"; empty when it does not say
  std::vector<std::string> names;  // of every point of the file
  std::vector<int> chosen;         // the points read: indices into names
  // [chosen][frame], the file's unit and axes; NaN where the point was not seen (empty, NaN, or
  // exactly zero in all three coordinates; joints of BVH files are always seen).
  std::vector<std::vector<Eigen::Vector3d>> positions;
  // The hierarchy of a BVH file, whose points are its joints, with offsets in the file's lengths,
  // and the values of all channels in the rows that were to be kept, row by row as they stand.
  std::shared_ptr<const BvhSkeleton> skeleton;
  std::vector<double> values;
  std::string content_hash;

  int num_frames() const { return positions.empty() ? 0 : static_cast<int>(positions[0].size()); }
};

// Three columns of a table that are one point, by name.
struct PointColumns {
  std::string name;
  std::string x, y, z;
};

struct PointReadOptions {
  // Indices of the points that are wanted, in the order wanted, by the names (and skeleton) that
  // stand in the motion already; throws an Error where one is not there. Unset: all. Only those
  // stay in memory where the file is text.
  std::function<std::vector<int>(const PointMotion& file)> choose;
  // Tables: the column of the time in s; empty: a column called time, Time, t, ... where there is
  // one.
  std::string time_column;
  // Tables: points whose columns do not follow a pattern such as hip_x, hip_y, hip_z (PointsOf).
  std::vector<PointColumns> columns;
  // BVH files: rows whose values are kept, 8 bytes per number.
  int first_kept = 0, kept_rows = 0;
};

// Sets the points that the options choose of motion->names, or throws the choice's Error.
void ChoosePoints(const PointReadOptions& options, PointMotion* motion);

// NaN where a point was not seen: not finite, or zero in all coordinates.
Eigen::Vector3d SeenPosition(const Eigen::Vector3d& position);

// Points as three columns of a table.

struct TablePoint {
  std::string name;
  int columns[3] = {-1, -1, -1};  // x, y, z
};

// Columns that belong together by their names: hip_x, hip_y, hip_z; hip.X, ...; hipX; hip:x; the
// point is called what is left without axis and separator. Columns without a partner are no points.
std::vector<TablePoint> PointsOf(const std::vector<std::string>& names);

// Tells columns of forces by their names. OpenSim's "ground_force_px" is where a force acts: its
// centre of pressure.
bool IsForceColumn(const std::string& name);

// Three columns of a force or a torque look like a point: all that do not.
PointMotion WithoutForces(const PointMotion& motion);

// Points are those of options.columns, otherwise of PointsOf. Errors besides those of the table:
// times that are not evenly spaced.
Result<PointMotion> ReadCsvPoints(const std::string& path, const PointReadOptions& options = {});
Result<PointMotion> ReadStoragePoints(const std::string& path,
                                      const PointReadOptions& options = {});

// TRC files (OpenSim, Motion Analysis): trajectories of markers as tab-separated text.
//
//   PathFileType  4  (X/Y/Z)  walk.trc
//   DataRate  CameraRate  NumFrames  NumMarkers  Units  OrigDataRate  OrigDataStartFrame  ...
//   100  100  580  2  mm  100  1  580
//   Frame#  Time  LASI      RASI
//                 X1 Y1 Z1  X2 Y2 Z2
//   1  0.00  ...
//
// Markers whose three cells are empty or NaN are not seen; at the end of a row their tabs may be
// left out.
//
// Errors name the line: a head that is none, more or fewer markers than announced, a row with other
// than its numbers, a marker with one or two of its three, a last row that is cut, wrong frame
// count.
Result<PointMotion> ReadTrc(const std::string& path, const PointReadOptions& options = {});

}  // namespace pushid
