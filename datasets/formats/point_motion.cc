// datasets: trajectories of named points, and those in tables.
#include "datasets/formats/point_motion.h"

#include <limits>
#include <numeric>
#include <unordered_map>

#include "datasets/files/names.h"

namespace pushid {

MaybeError ChoosePoints(const PointReadOptions& options, PointMotion* motion) {
  if (!options.choose) {
    motion->chosen.resize(motion->names.size());
    std::iota(motion->chosen.begin(), motion->chosen.end(), 0);
    return std::nullopt;
  }
  Result<std::vector<int>> chosen = options.choose(motion->names);
  if (!chosen.ok()) return chosen.error();
  motion->chosen = std::move(chosen.value());
  return std::nullopt;
}

Eigen::Vector3d SeenPosition(const Eigen::Vector3d& position) {
  const bool seen = position.allFinite() && !position.isZero(0.0);
  return seen ? position : Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
}

namespace {

// "hip_x" -> "hip_"; empty when the name does not end in the axis.
std::string Stem(const std::string& name, char axis) {
  if (name.size() < 2 || (name.back() | 0x20) != axis) return "";
  return name.substr(0, name.size() - 1);
}

std::string WithoutSeparator(std::string stem) {
  while (!stem.empty() && std::string("_.:- ").find(stem.back()) != std::string::npos) {
    stem.pop_back();
  }
  return stem;
}

Result<std::vector<TablePoint>> NamedPoints(const std::string& path,
                                            const std::vector<std::string>& names,
                                            const std::vector<PointColumns>& wanted) {
  std::vector<TablePoint> points;
  for (const PointColumns& one : wanted) {
    TablePoint point;
    point.name = one.name;
    const std::string* columns[] = {&one.x, &one.y, &one.z};
    for (int axis = 0; axis < 3; ++axis) {
      for (std::size_t i = 0; i < names.size(); ++i) {
        if (names[i] == *columns[axis]) point.columns[axis] = static_cast<int>(i);
      }
      if (point.columns[axis] < 0) {
        return UnknownNameError(path, "column", names, *columns[axis]);
      }
    }
    points.push_back(point);
  }
  return points;
}

}  // namespace

std::vector<TablePoint> PointsOf(const std::vector<std::string>& names) {
  std::unordered_map<std::string, int> index;
  for (std::size_t i = 0; i < names.size(); ++i) index.emplace(names[i], static_cast<int>(i));
  std::vector<TablePoint> points;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string stem = Stem(names[i], 'x');
    if (stem.empty()) continue;
    const bool upper = names[i].back() == 'X';
    const auto y = index.find(stem + (upper ? 'Y' : 'y'));
    const auto z = index.find(stem + (upper ? 'Z' : 'z'));
    if (y == index.end() || z == index.end()) continue;
    TablePoint point;
    point.name = WithoutSeparator(stem);
    if (point.name.empty()) continue;
    point.columns[0] = static_cast<int>(i);
    point.columns[1] = y->second;
    point.columns[2] = z->second;
    points.push_back(point);
  }
  return points;
}

bool IsForceColumn(const std::string& name) {
  if (!Holds(name, "force")) return false;
  const std::size_t end = name.size();
  return end < 3 || name[end - 3] != '_' || name[end - 2] != 'p';
}

PointMotion WithoutForces(const PointMotion& motion) {
  PointMotion points = motion;
  points.names.clear();
  points.chosen.clear();
  points.positions.clear();
  for (std::size_t i = 0; i < motion.names.size(); ++i) {
    const std::string& name = motion.names[i];
    if (Holds(name, "force") || Holds(name, "torque") || Holds(name, "moment")) continue;
    points.chosen.push_back(static_cast<int>(points.names.size()));
    points.names.push_back(name);
    points.positions.push_back(motion.positions[i]);
  }
  return points;
}

namespace {

// Columns x, y and z of each of the chosen points.
std::vector<int> ColumnsOf(const std::vector<TablePoint>& points, const std::vector<int>& chosen) {
  std::vector<int> columns;
  for (int index : chosen) {
    columns.insert(columns.end(), points[index].columns, points[index].columns + 3);
  }
  return columns;
}

// The table keeps the columns of the chosen points first.
void TakeTracks(const NumericTable& table, PointMotion* motion) {
  for (std::size_t i = 0; i < motion->chosen.size(); ++i) {
    const std::vector<double>*x = &table.data[3 * i], *y = x + 1, *z = x + 2;
    std::vector<Eigen::Vector3d>& track = motion->positions.emplace_back(table.num_rows());
    for (int row = 0; row < table.num_rows(); ++row) {
      track[row] = SeenPosition({(*x)[row], (*y)[row], (*z)[row]});
    }
  }
}

Result<PointMotion> ReadTablePoints(const std::string& path, TableFormat format,
                                    const PointReadOptions& options) {
  PointMotion motion;
  motion.path = path;
  std::vector<TablePoint> points;
  int time_column = -1;
  TableReadOptions table_options;
  table_options.keep_lines = true;
  table_options.choose = [&](const std::vector<std::string>& names) -> Result<std::vector<int>> {
    if (options.columns.empty()) {
      points = PointsOf(names);
    } else {
      Result<std::vector<TablePoint>> named = NamedPoints(path, names, options.columns);
      if (!named.ok()) return named.error();
      points = named.value();
    }
    time_column = FindTimeColumn(names, options.time_column);
    if (time_column < 0 && !options.time_column.empty()) {
      return Error{"there is no column '" + options.time_column + "' for the time", path};
    }
    for (const TablePoint& point : points) motion.names.push_back(point.name);
    if (!points.empty()) {
      if (MaybeError failed = ChoosePoints(options, &motion)) return *std::move(failed);
    }
    std::vector<int> columns = ColumnsOf(points, motion.chosen);
    if (time_column >= 0) columns.push_back(time_column);
    if (columns.empty() && !names.empty()) columns.push_back(0);  // counts the rows
    return columns;
  };
  const Result<NumericTable> table = ReadNumericTable(path, format, table_options);
  if (!table.ok()) return table.error();
  motion.content_hash = table.value().content_hash;
  if (time_column >= 0) {
    const Result<double> step = EvenTimeStep(table.value(), time_column);
    if (!step.ok()) return step.error();
    motion.rate_hz = 1.0 / step.value();
    motion.first_time_s = table.value().data.back().front();
  }
  TakeTracks(table.value(), &motion);
  return motion;
}

}  // namespace

Result<PointMotion> ReadCsvPoints(const std::string& path, const PointReadOptions& options) {
  return ReadTablePoints(path, TableFormat::kCsv, options);
}

Result<PointMotion> ReadStoragePoints(const std::string& path, const PointReadOptions& options) {
  return ReadTablePoints(path, TableFormat::kStorage, options);
}

}  // namespace pushid
