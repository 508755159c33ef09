// datasets: the formats of motion files.
#include "datasets/formats/motion_formats.h"

#include <algorithm>
#include <iterator>

#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
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
      if (ending != nullptr) endings.push_back(StrCat(".", ending));
    }
  }
  return ListOfNames(endings);
}

std::string MotionKeys() { return ListOfNames(AllNames<MotionFormat>()); }

Result<PointMotion> ReadPointMotion(const std::string& path, MotionFormat format,
                                    const PointReadOptions& options) {
  const MotionFormatRow& row = RowOf(format);
  Result<PointMotion> motion = row.read(path, options);
  if (!motion.ok() || !motion.value().names.empty()) return motion;
  return Error{StrCat("the file has no points",
                      row.table ? ": no three columns such as hip_x, hip_y, hip_z; name "
                                  "them in a mapping file"
                                : ""),
               path};
}

Result<double> ReadFrameRate(const std::string& path, MotionFormat format,
                             const PointReadOptions& options) {
  return Caught([&] {
    if (HasSkeleton(format)) return WholeFrameRate(1.0 / OrThrow(ReadBvhFrameTime(path)));
    PointReadOptions none = options;
    none.choose = [](const PointMotion&) { return std::vector<int>{}; };
    return WholeFrameRate(OrThrow(ReadPointMotion(path, format, none)).rate_hz);
  });
}

TimedColumns ReadTimedColumns(const std::string& path, const Choice& choose) {
  const MotionFormat format = MotionFormatOfFile(path).value_or(MotionFormat::kCsv);
  std::vector<int> columns;
  int time = -1;
  NumericTable table = OrThrow(
      ReadNumericTable(path, RowOf(format).table.value_or(TableFormat::kCsv),
                       [&](const std::vector<std::string>& names) {
                         time = FindTimeColumn(names, "");
                         if (time < 0) throw Error{"there is no column called time", path};
                         columns = choose(names);
                         std::vector<int> wanted;
                         std::copy_if(columns.begin(), columns.end(), std::back_inserter(wanted),
                                      [](int column) { return column >= 0; });
                         wanted.push_back(time);
                         return wanted;
                       }));
  if (table.num_rows() < 3) {
    throw Error{StrCat("it has ", table.num_rows(), " rows; three or more are needed"), path};
  }
  TimedColumns read;
  read.file = path;
  read.rate_hz = 1.0 / OrThrow(EvenTimeStep(table, time));
  read.first_s = table.data.back()[0];
  read.lines = std::move(table.lines);
  size_t next = 0;
  for (int column : columns) {
    read.values.push_back(column >= 0 ? std::move(table.data[next++]) : std::vector<double>());
  }
  return read;
}

}  // namespace pushid
