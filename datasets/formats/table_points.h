// datasets: points as three columns of a table.
#pragma once

#include <string>
#include <vector>

#include "datasets/formats/point_motion.h"

namespace pushid {

struct TablePoint {
  std::string name;
  int columns[3] = {-1, -1, -1};  // x, y, z
};

// Columns that belong together by their names: hip_x, hip_y, hip_z; hip.X, ...; hipX; hip:x; the
// point is called what is left without axis and separator. Columns without a partner are no points.
std::vector<TablePoint> PointsOf(const std::vector<std::string>& names);

// By name. "ground_force_px", of OpenSim, is where a force acts: its centre of pressure.
bool IsForceColumn(const std::string& name);

// Three columns of a force or a torque look like a point: all that do not.
PointMotion WithoutForces(const PointMotion& motion);

// Points are those of options.columns, otherwise of PointsOf. Errors besides those of the table:
// times that are not evenly spaced.
Result<PointMotion> ReadCsvPoints(const std::string& path, const PointReadOptions& options = {});
Result<PointMotion> ReadStoragePoints(const std::string& path,
                                      const PointReadOptions& options = {});

}  // namespace pushid
