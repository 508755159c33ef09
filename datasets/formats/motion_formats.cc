// datasets: the formats of motion files.
#include "datasets/formats/motion_formats.h"

#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "datasets/formats/bvh.h"
#include "datasets/formats/units.h"

namespace pushid {
std::optional<MotionFormat> MotionFormatOfFile(std::string_view path) {
  const std::size_t dot = path.rfind('.');
  if (dot == std::string_view::npos) return std::nullopt;
  for (const MotionFormatRow& row : kMotionFormats) {
    for (const char* ending : row.endings) {
      if (ending != nullptr && EqualsIgnoringCase(path.substr(dot + 1), ending)) return row.value;
    }
  }
  return std::nullopt;
}

std::optional<MotionFormat> MotionFormatInFile(const std::string& path) {
  const std::optional<MotionFormat> format = MotionFormatOfFile(path);
  return format == MotionFormat::kCsv && IsCrowdCsv(path) ? MotionFormat::kTrajectoryText : format;
}

std::string MotionFileEndings() {
  std::vector<std::string> endings;
  for (const MotionFormatRow& row : kMotionFormats) {
    for (const char* ending : row.endings) {
      if (ending != nullptr) endings.push_back(std::string(".") + ending);
    }
  }
  return ListOfNames(endings);
}

std::string MotionKeys() { return ListOfNames(AllNames<MotionFormat>()); }

Result<PointMotion> ReadPointMotion(const std::string& path, MotionFormat format,
                                    const PointReadOptions& options) {
  const MotionFormatRow& row = RowOf(format);
  if (row.read == nullptr) return Error{"a skeleton's joints are no points", path};
  Result<PointMotion> motion = row.read(path, options);
  if (!motion.ok()) return motion;
  if (motion.value().names.empty()) {
    return Error{"the file has no points" +
                     std::string(row.table ? ": no three columns such as hip_x, hip_y, hip_z; name "
                                             "them in a mapping file"
                                           : ""),
                 path};
  }
  return motion;
}

Result<double> ReadFrameRate(const std::string& path, MotionFormat format,
                             const PointReadOptions& options) {
  if (HasSkeleton(format)) {
    const Result<double> frame_time = ReadBvhFrameTime(path);
    if (!frame_time.ok()) return frame_time;
    return WholeFrameRate(1.0 / frame_time.value());
  }
  PointReadOptions none = options;
  none.choose = [](const std::vector<std::string>&) { return std::vector<int>{}; };
  const Result<PointMotion> motion = ReadPointMotion(path, format, none);
  if (!motion.ok()) return motion.error();
  return WholeFrameRate(motion.value().rate_hz);
}

Result<TimedColumns> ReadTimedColumns(
    const std::string& path,
    const std::function<Result<std::vector<int>>(const std::vector<std::string>&)>& choose) {
  const MotionFormat format = MotionFormatOfFile(path).value_or(MotionFormat::kCsv);
  std::vector<int> columns;
  int time = -1;
  TableReadOptions options;
  options.keep_lines = true;
  options.choose = [&](const std::vector<std::string>& names) -> Result<std::vector<int>> {
    time = FindTimeColumn(names, "");
    if (time < 0) return Error{"there is no column called time", path};
    const Result<std::vector<int>> chosen = choose(names);
    if (!chosen.ok()) return chosen.error();
    columns = chosen.value();
    std::vector<int> wanted;
    for (int column : columns) {
      if (column >= 0) wanted.push_back(column);
    }
    wanted.push_back(time);
    return wanted;
  };
  const Result<NumericTable> table =
      ReadNumericTable(path, RowOf(format).table.value_or(TableFormat::kCsv), options);
  if (!table.ok()) return table.error();
  TimedColumns read;
  read.file = path;
  read.lines = table.value().lines;
  if (table.value().num_rows() < 3) {
    return Error{
        "it has " + std::to_string(table.value().num_rows()) + " rows; three or more are needed",
        path};
  }
  const Result<double> step = EvenTimeStep(table.value(), time);
  if (!step.ok()) return step.error();
  read.rate_hz = 1.0 / step.value();
  read.first_s = table.value().data.back()[0];
  size_t next = 0;
  for (int column : columns) {
    read.values.push_back(column >= 0 ? table.value().data[next++] : std::vector<double>());
  }
  return read;
}

}  // namespace pushid
