// datasets: records of force sensors as CSV files, and lists of sensors.
#include "datasets/sensors/sensor_csv.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

#include "datasets/files/input_file.h"
#include "datasets/files/json_fields.h"
#include "datasets/files/number_text.h"
#include "datasets/manifest/manifest.h"
#include "datasets/sensors/sensor_choice.h"

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

namespace {

using Json = nlohmann::ordered_json;

void ReadDirection(JsonFields* fields, SensorChoice* sensor) {
  if (!fields->Has("direction")) return;
  const Json& value = fields->At("direction");
  bool numbers = value.is_array() && value.size() == 3;
  for (std::size_t i = 0; numbers && i < 3; ++i) numbers = value[i].is_number();
  if (!numbers) {
    fields->Fail("direction", "must be [x, y, z], as in [1, 0, 0], not " + Shown(value));
    return;
  }
  for (int i = 0; i < 3; ++i) sensor->direction[i] = value[i].get<double>();
}

}  // namespace

Result<std::vector<SensorChoice>> ReadSensorList(const std::string& path) {
  const Result<JsonDocument> document = ReadJsonDocument(path);
  if (!document.ok()) return document.error();
  const Json& content = document.value().content;
  if (!content.is_array() || content.empty()) {
    return document.value().ErrorAt("", "a list of sensors is expected, [{\"file\": ...}, ...]");
  }
  std::vector<SensorChoice> sensors;
  for (std::size_t i = 0; i < content.size(); ++i) {
    JsonFields fields(document.value(), content[i], "/" + std::to_string(i),
                      "sensor " + std::to_string(i));
    SensorChoice sensor;
    sensor.file = ResolvePath(path, fields.Text("file", "the name of a file with forces"));
    sensor.column = fields.OptionalText("column", "");
    sensor.gain = fields.OptionalNumber("gain", "the N per unit", 1.0);
    sensor.up = fields.OptionalText("up", "");
    sensor.forward = fields.OptionalText("forward", "");
    ReadDirection(&fields, &sensor);
    sensor.height_fraction = fields.OptionalNumber("height", "a fraction of the rod", 1.0);
    if (fields.Has("height_m")) sensor.height_m = fields.Number("height_m", "a height in m");
    if (fields.Has("height") && fields.Has("height_m")) {
      fields.Fail("height", "is given together with height_m; give one of them");
    }
    if (fields.Has("start")) sensor.start_s = fields.Number("start", "its clock at frame 0 in s");
    sensor.idle_force = fields.OptionalNumber("idle_force", "a force in N", 0.0);
    sensor.zero_n = fields.OptionalNumber("zero", "what it reads at rest in N", 0.0);
    if (!fields.error() && !(sensor.idle_force >= 0.0)) {
      fields.Fail("idle_force", "must be a force of at least 0 N");
    }
    fields.OnlyAsked();
    if (fields.error()) return *fields.error();
    sensors.push_back(sensor);
  }
  return sensors;
}

}  // namespace pushid
