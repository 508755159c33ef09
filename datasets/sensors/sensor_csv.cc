// datasets: records of force sensors as CSV files.
#include "datasets/sensors/sensor_csv.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "datasets/files/input_file.h"
#include "datasets/files/number_text.h"

namespace pushid {
namespace {

constexpr int kMinSamples = 3;

MaybeError ParseRow(const LineReader& reader, std::string_view line,
                    const std::vector<std::string>& columns, std::vector<double>* row) {
  const std::vector<std::string_view> fields = CellsOf(line, ',');
  if (fields.size() != columns.size()) {
    return reader.ErrorHere("the row has " + std::to_string(fields.size()) + " values, not " +
                            std::to_string(columns.size()));
  }
  for (size_t i = 0; i < columns.size(); ++i) {
    if (fields[i].empty()) {
      return reader.ErrorHere(columns[i] + " is missing; fill the gap or cut the record there");
    }
    if (!ParseDouble(fields[i], &(*row)[i])) {
      return reader.ErrorHere(columns[i] + ": " + NumberProblem(fields[i]));
    }
  }
  return {};
}

// The first pause that is no sampling interval any more. `lines` holds each sample's line.
MaybeError FindGap(const SensorRecord& record, const std::vector<int>& lines) {
  std::vector<double> pauses;
  for (int i = 1; i < record.num_samples(); ++i) {
    pauses.push_back(record.time_s[i] - record.time_s[i - 1]);
  }
  std::vector<double> sorted = pauses;
  std::nth_element(sorted.begin(), sorted.begin() + sorted.size() / 2, sorted.end());
  const double usual = sorted[sorted.size() / 2];
  for (size_t i = 0; i < pauses.size(); ++i) {
    if (pauses[i] > kMaxSensorPause * usual) {
      return Error{"no samples for " + Rounded(pauses[i]) + " s, from " +
                       Rounded(record.time_s[i]) + " s to " + Rounded(record.time_s[i + 1]) +
                       " s, where " + Rounded(usual) +
                       " s is usual; fill the gap or cut the record there",
                   record.file, lines[i + 1]};
    }
  }
  return {};
}

}  // namespace

Result<SensorRecord> ReadSensorCsv(const std::string& path) {
  LineReader reader;
  if (MaybeError failed = reader.Open(path)) return *std::move(failed);
  std::string_view line;
  if (!reader.NextNonBlank(&line)) {
    if (reader.error()) return *reader.error();
    return Error{"the file is empty; a sensor record starts with time,force or time,fx,fy,fz", path,
                 0};
  }
  SensorRecord record;
  record.file = path;
  const std::vector<std::string_view> cells = CellsOf(line, ',');
  const std::vector<std::string> columns(cells.begin(), cells.end());
  record.is_vector = columns == std::vector<std::string>{"time", "fx", "fy", "fz"};
  if (!record.is_vector && columns != std::vector<std::string>{"time", "force"}) {
    return reader.ErrorHere("the header is " + Quoted(line) +
                            ", neither time,force nor time,fx,fy,fz");
  }

  std::vector<int> lines;
  std::vector<double> row(columns.size());
  while (reader.NextNonBlank(&line)) {
    if (MaybeError failed = ParseRow(reader, line, columns, &row)) return *std::move(failed);
    if (!record.time_s.empty() && row[0] <= record.time_s.back()) {
      return reader.ErrorHere("time " + Rounded(row[0], 9) + " s does not come after " +
                              Rounded(record.time_s.back(), 9) +
                              " s; samples must be in ascending order, each once");
    }
    record.time_s.push_back(row[0]);
    record.force.push_back(record.is_vector ? Eigen::Vector3d(row[1], row[2], row[3])
                                            : Eigen::Vector3d(row[1], 0.0, 0.0));
    lines.push_back(reader.line_number());
  }
  if (reader.error()) return *reader.error();
  if (record.num_samples() < kMinSamples) {
    return reader.ErrorHere("the record ends after " + std::to_string(record.num_samples()) +
                            " samples; a push needs at least " + std::to_string(kMinSamples));
  }
  if (MaybeError gap = FindGap(record, lines)) return *std::move(gap);
  return record;
}

}  // namespace pushid
