// datasets: forces as CSV files.
#include "datasets/formats/force_csv.h"

#include <algorithm>
#include <iterator>
#include <string_view>

#include "datasets/files/atomic_file.h"
#include "datasets/files/input_file.h"
#include "datasets/files/number_text.h"

namespace pushid {
namespace {

constexpr char kHeader[] = "frame,fx,fy,ftheta,fphi";
constexpr const char* kPushColumns[] = {"frame", "fx", "fy", "ftheta", "fphi"};
constexpr std::size_t kNumColumns = 5, kWithoutTorques = 3;

// How many of the columns of a push the header names; 0 where it is another.
std::size_t ColumnsOf(std::string_view line) {
  const std::vector<std::string_view> cells = CellsOf(line, ',');
  const bool named = cells.size() <= kNumColumns &&
                     std::equal(cells.begin(), cells.end(), std::begin(kPushColumns));
  return named && (cells.size() == kNumColumns || cells.size() == kWithoutTorques) ? cells.size()
                                                                                   : 0;
}

MaybeError ParsePushRow(const LineReader& reader, std::string_view line, std::size_t columns,
                        std::int64_t expected_frame, Eigen::Vector4d* force) {
  const std::vector<std::string_view> cells = CellsOf(line, ',');
  for (std::size_t i = 0; i < columns; ++i) {
    if (i == cells.size()) {
      return reader.ErrorHere("the row has " + std::to_string(i) + " values, not " +
                              std::to_string(columns) + " (" + kHeader + ")");
    }
    const std::string_view field = cells[i];
    if (i > 0) {
      if (!ParseDouble(field, &(*force)[i - 1])) {
        return reader.ErrorHere(std::string(kPushColumns[i]) + ": " + NumberProblem(field));
      }
      continue;
    }
    std::int64_t frame = 0;
    if (!ParseInteger(field, &frame)) {
      return reader.ErrorHere("frame: " + Quoted(field) + " is not a whole number");
    }
    if (frame != expected_frame) {
      return reader.ErrorHere("frame is " + std::to_string(frame) + " where " +
                              std::to_string(expected_frame) +
                              " was expected; rows must count 0, 1, 2, ... without gaps (a late "
                              "push is given by start_frame in the manifest)");
    }
  }
  if (cells.size() > columns) {
    return reader.ErrorHere("the row has more than " + std::to_string(columns) + " values (" +
                            kHeader + ")");
  }
  return std::nullopt;
}

constexpr int kMinSamples = 3;

MaybeError ParseSensorRow(const LineReader& reader, std::string_view line,
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

Result<PushRows> ReadPushCsv(const std::string& path) {
  LineReader reader;
  if (MaybeError failed = reader.Open(path)) return *std::move(failed);
  std::string_view line;
  if (!reader.NextNonBlank(&line)) {
    if (reader.error()) return *reader.error();
    return Error{std::string("the file is empty; a push starts with the line ") + kHeader, path, 0};
  }
  const std::size_t columns = ColumnsOf(line);
  if (columns == 0) {
    return reader.ErrorHere("the header is " + Quoted(line) + ", not " + kHeader +
                            " (or frame,fx,fy of a push at the manifest's push_height_m)");
  }
  PushRows push;
  push.has_torques = columns == kNumColumns;
  std::vector<Eigen::Vector4d>& force = push.force;
  while (reader.NextNonBlank(&line)) {
    Eigen::Vector4d row = Eigen::Vector4d::Zero();
    if (MaybeError failed =
            ParsePushRow(reader, line, columns, static_cast<std::int64_t>(force.size()), &row)) {
      return *std::move(failed);
    }
    force.push_back(row);
  }
  if (reader.error()) return *reader.error();
  if (force.empty()) {
    return reader.ErrorHere(
        "the push has no rows; leave push_csv out of the manifest for a recording without a push");
  }
  return push;
}

MaybeError WritePushCsv(const std::string& path, const std::vector<Eigen::Vector4d>& force) {
  if (force.empty()) return Error{"a push without rows is not written", path, 0};
  std::string text = std::string(kHeader) + "\n";
  for (std::size_t frame = 0; frame < force.size(); ++frame) {
    if (!force[frame].allFinite()) {
      return Error{"row " + std::to_string(frame) + " of the push to write is not finite", path, 0};
    }
    text += std::to_string(frame);
    for (int i = 0; i < 4; ++i) {
      text += ',';
      AppendDouble(force[frame][i], &text);
    }
    text += '\n';
  }
  return WriteFileAtomically(path, text);
}

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
    if (MaybeError failed = ParseSensorRow(reader, line, columns, &row)) return *std::move(failed);
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
