// datasets: trajectories of named points.
#include "datasets/formats/point_motion.h"

#include <limits>
#include <unordered_map>

#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "datasets/files/numeric_table.h"

namespace pushid {

Error UnknownPointError(const std::string& path, const std::vector<std::string>& names,
                        const std::string& name) {
  constexpr std::size_t kListed = 8;
  std::string message = "there is no point " + Quoted(name) + "; it has ";
  for (std::size_t i = 0; i < names.size() && i < kListed; ++i) {
    message += (i > 0 ? ", " : "") + names[i];
  }
  if (names.size() > kListed) message += ", ... (" + std::to_string(names.size()) + " points)";
  return {message + MeantText(name, names), path};
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
        Error error = UnknownPointError(path, names, *columns[axis]);
        error.message.replace(error.message.find("point"), 5, "column");
        return error;
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
    for (std::size_t i = 0; i < points.size(); ++i) motion.chosen.push_back(static_cast<int>(i));
    if (options.choose && !points.empty()) {
      Result<std::vector<int>> chosen = options.choose(motion.names);
      if (!chosen.ok()) return chosen.error();
      motion.chosen = std::move(chosen.value());
    }
    std::vector<int> columns;
    for (int index : motion.chosen) {
      columns.insert(columns.end(), points[index].columns, points[index].columns + 3);
    }
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
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::vector<double>>& data = table.value().data;
  for (std::size_t i = 0; i < motion.chosen.size(); ++i) {
    std::vector<Eigen::Vector3d> track;
    track.reserve(table.value().num_rows());
    for (int row = 0; row < table.value().num_rows(); ++row) {
      const Eigen::Vector3d position(data[3 * i][row], data[3 * i + 1][row], data[3 * i + 2][row]);
      const bool seen = position.allFinite() && !position.isZero(0.0);
      track.push_back(seen ? position : Eigen::Vector3d::Constant(kNaN));
    }
    motion.positions.push_back(std::move(track));
  }
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
