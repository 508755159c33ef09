// datasets: reading columns with their times.
#include <algorithm>
#include <cmath>

#include "datasets/files/number_text.h"
#include "datasets/files/numeric_table.h"
#include "datasets/formats/motion_formats.h"
#include "datasets/sensors/sensor_choice.h"

namespace pushid {

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

MaybeError CheckLasts(const RecordTimes& times, const std::string& file, int line) {
  const double frame = 1.0 / times.fps, end_s = times.start_s + times.seconds;
  const bool begins = times.first_s <= times.start_s + 0.5 * frame;
  if (begins && times.last_s >= end_s - times.spare * frame) return {};
  return Error{std::string(times.lasts) + " from " + Rounded(times.first_s, 4) + " to " +
                   Rounded(times.last_s, 4) + " s, but the motion from " +
                   Rounded(times.start_s, 4) + " to " + Rounded(end_s, 4) +
                   " s of that clock; record it longer, cut the motion (end_frame), or give the "
                   "right clock at frame 0 as \"start\"",
               file, line};
}

Eigen::Vector3d ValueBetween(const std::vector<Eigen::Vector3d>& track, double at) {
  const int last = static_cast<int>(track.size()) - 1;
  if (at <= 0.0) return track[0];
  if (at >= last) return track[last];
  const int nodes = std::min(4, last + 1);
  const int first = std::clamp(static_cast<int>(at) - 1, 0, last + 1 - nodes);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < nodes; ++i) {
    double weight = 1.0;
    for (int k = 0; k < nodes; ++k) {
      if (k != i) weight *= (at - first - k) / (i - k);
    }
    sum += weight * track[first + i];
  }
  return sum;
}

}  // namespace pushid
