// datasets: platforms of tables: columns behind prefixes, with centres of pressure or moments.
#include <Eigen/Geometry>
#include <algorithm>

#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "datasets/loading/plate_record.h"
#include "datasets/sensors/sensor_choice.h"

namespace pushid {
namespace {

// Columns of one platform: fx, fy, fz, then px, py, pz or mx, my, mz.
struct PlateColumns {
  static constexpr int kCount = 9, kMoments = 6;
  int index[kCount] = {-1, -1, -1, -1, -1, -1, -1, -1, -1};
  bool Has(int from, int needed) const {
    return std::count_if(index + from, index + from + 3, [](int i) { return i >= 0; }) >= needed;
  }
  // With two coordinates of the centre, whichever of the file's axes are level.
  bool Complete() const { return Has(0, 3) && (Has(3, 2) || Has(kMoments, 3)); }
};

PlateColumns ColumnsOf(const std::string& prefix, const std::vector<std::string>& names) {
  constexpr const char* kEndings[PlateColumns::kCount][2] = {
      {"fx", "vx"}, {"fy", "vy"}, {"fz", "vz"}, {"px", "px"}, {"py", "py"},
      {"pz", "pz"}, {"mx", "mx"}, {"my", "my"}, {"mz", "mz"}};
  PlateColumns columns;
  for (int i = 0; i < PlateColumns::kCount; ++i) {
    for (const char* ending : kEndings[i]) {
      for (const std::string& between : {std::string(), std::string("_")}) {
        const auto found = std::find(names.begin(), names.end(), prefix + between + ending);
        if (found != names.end()) columns.index[i] = static_cast<int>(found - names.begin());
      }
    }
  }
  return columns;
}

// Whatever stands before the endings.
std::vector<std::string> PrefixesIn(const std::vector<std::string>& names) {
  std::vector<std::string> prefixes;
  for (const std::string& name : names) {
    if (name.size() < 2) continue;
    const std::string ending = name.substr(name.size() - 2);
    if (ending != "fx" && ending != "vx") continue;
    std::string prefix = name.substr(0, name.size() - 2);
    if (!prefix.empty() && prefix.back() == '_') prefix.pop_back();
    if (ColumnsOf(prefix, names).Complete() || !prefix.empty()) prefixes.push_back(prefix);
  }
  return prefixes;
}

// The columns of each platform that are read; up: the file's axis that points there.
Result<std::vector<PlateColumns>> PlateColumnsIn(const std::string& path,
                                                 const ManifestPlates& plates, int up,
                                                 const std::vector<std::string>& names) {
  std::vector<PlateColumns> all;
  for (const std::string& prefix : plates.plates.empty() ? PrefixesIn(names) : plates.plates) {
    PlateColumns columns = ColumnsOf(prefix, names);
    const std::string whose = prefix.empty() ? "the platform" : Quoted(prefix);
    const bool moments = !columns.Has(3, 2) && columns.Has(PlateColumns::kMoments, 3);
    if (moments && !plates.origin && columns.Has(0, 3)) {
      return Error{whose +
                       " has moments (mx, my, mz) and no centre of pressure; give the point "
                       "that they are about as \"origin\" of force_plates: [x, y, z] in m",
                   path};
    }
    // The centre's height is not needed, and may be empty.
    const bool by_moments = plates.origin && columns.Has(PlateColumns::kMoments, 3);
    const int unused = by_moments ? 3 : PlateColumns::kMoments;
    std::fill(columns.index + unused, columns.index + unused + 3, -1);
    columns.index[3 + up] = -1;
    if (!columns.Has(0, 3) || !columns.Has(by_moments ? PlateColumns::kMoments : 3, 2)) {
      return Error{"a column of " + whose +
                       " is missing: fx, fy, fz (or vx, vy, vz) and the two of px, py, pz that are "
                       "level are needed, or mx, my, mz and \"origin\"; it has " +
                       ListOfNames(names),
                   path};
    }
    all.push_back(columns);
  }
  if (!all.empty()) return all;
  return Error{
      "there are no columns of a force platform (time,fx,fy,fz,px,py, or "
      "time,fx,fy,fz,mx,my,mz); it has " +
          ListOfNames(names),
      path};
}

// Where a force with this moment about the origin, all in the project's axes, meets the ground at
// height 0: M = r x F but for a moment about the vertical.
Eigen::Vector3d CentreByMoment(const Eigen::Vector3d& force, const Eigen::Vector3d& moment,
                               const Eigen::Vector3d& origin) {
  const double up = -origin.z();
  return {origin.x() + (up * force.x() - moment.y()) / force.z(),
          origin.y() + (up * force.y() + moment.x()) / force.z(), 0.0};
}

}  // namespace

Result<PlateTracks> PlatesOfTable(const std::string& path, const ManifestPlates& plates,
                                  const Eigen::Matrix3d& axes) {
  Eigen::Index up;
  axes.row(2).cwiseAbs().maxCoeff(&up);
  std::vector<PlateColumns> all;
  const Result<TimedColumns> read = ReadTimedColumns(
      path, [&](const std::vector<std::string>& names) -> Result<std::vector<int>> {
        const auto chosen = PlateColumnsIn(path, plates, static_cast<int>(up), names);
        if (!chosen.ok()) return chosen.error();
        all = chosen.value();
        std::vector<int> columns;
        for (const PlateColumns& one : all) {
          columns.insert(columns.end(), one.index, one.index + PlateColumns::kCount);
        }
        return columns;
      });
  if (!read.ok()) return read.error();
  const TimedColumns& table = read.value();
  PlateTracks tracks;
  tracks.file = path;
  tracks.rate_hz = table.rate_hz;
  tracks.first_s = table.first_s;
  tracks.last_line = table.lines.back();
  tracks.platforms = static_cast<int>(all.size());
  const auto at = [&](size_t plate, int first, int row) {
    Eigen::Vector3d value;
    for (int i = 0; i < 3; ++i) {
      const std::vector<double>& column =
          table.values[PlateColumns::kCount * plate + static_cast<size_t>(first + i)];
      value[i] = column.empty() ? 0.0 : column[static_cast<size_t>(row)];
    }
    return Eigen::Vector3d(axes * value);
  };
  for (size_t plate = 0; plate < all.size(); ++plate) {
    const bool by_moments = all[plate].Has(PlateColumns::kMoments, 3);
    // Files hold the force on the person or on the platform, which can only be pressed.
    double vertical = 0.0;
    for (int row = 0; by_moments && row < table.num_rows(); ++row) {
      vertical += at(plate, 0, row).z();
    }
    const double sign = vertical < 0.0 ? -1.0 : 1.0;
    for (int row = 0; row < table.num_rows(); ++row) {
      const Eigen::Vector3d force = sign * at(plate, 0, row);
      if (!force.allFinite()) {
        return Error{"a force of the platform is missing; fill the gap", path,
                     table.lines[static_cast<size_t>(row)]};
      }
      tracks.Add(static_cast<size_t>(row), force,
                 by_moments ? CentreByMoment(force, sign * at(plate, PlateColumns::kMoments, row),
                                             axes * *plates.origin)
                            : at(plate, 3, row));
    }
  }
  return tracks;
}

}  // namespace pushid
