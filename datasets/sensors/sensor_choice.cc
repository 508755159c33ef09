// datasets: force sensors in any file, and lists of them.
#include "datasets/sensors/sensor_choice.h"

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "datasets/files/json_fields.h"
#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "datasets/files/numeric_table.h"
#include "datasets/formats/c3d.h"
#include "datasets/formats/motion_formats.h"
#include "datasets/formats/units.h"
#include "datasets/manifest/manifest.h"
#include "datasets/sensors/force_platform.h"

namespace pushid {
namespace {

constexpr char kPlatform[] = "platform:";

Error NoColumn(const SensorChoice& choice, const char* noun,
               const std::vector<std::string>& names) {
  return UnknownNameError(choice.file, noun, names, choice.column);
}

std::vector<std::string> ChannelNames(const C3dFile& file) {
  std::vector<std::string> names;
  for (const C3dAnalogChannel& channel : file.analog) names.push_back(channel.name);
  return names;
}

// The column of this name, or the three whose common part it is; empty: none.
std::vector<int> ColumnsCalled(const std::string& name, const std::vector<std::string>& names) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == name) return {static_cast<int>(i)};
  }
  for (const TablePoint& point : PointsOf(names)) {
    if (point.name == name) return {point.columns, point.columns + 3};
  }
  return {};
}

// A column or three of a table ("cell" for cell_x, cell_y, cell_z), whose clock starts with the
// file.
Result<SensorRecord> FromTable(const SensorChoice& choice) {
  const Result<TimedColumns> read = ReadTimedColumns(
      choice.file, [&](const std::vector<std::string>& names) -> Result<std::vector<int>> {
        const std::vector<int> columns = ColumnsCalled(choice.column, names);
        if (!columns.empty()) return columns;
        return NoColumn(choice, "column", names);
      });
  if (!read.ok()) return read.error();
  const TimedColumns& table = read.value();
  SensorRecord record;
  record.is_vector = table.values.size() == 3;
  for (int row = 0; row < table.num_rows(); ++row) {
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < table.values.size(); ++i) force[i] = table.values[i][row];
    if (!force.allFinite()) {
      return Error{choice.column + " is missing; fill the gap or cut the record there", choice.file,
                   table.lines[row]};
    }
    record.time_s.push_back(table.first_s + row / table.rate_hz);
    record.force.push_back(force);
  }
  return record;
}

// For files that hold more than a push.
Error WhichColumn(const SensorChoice& choice, MotionFormat format) {
  std::vector<std::string> names;
  if (format == MotionFormat::kC3d) {
    const Result<C3dFile> file = ReadC3d(choice.file);
    if (!file.ok()) return file.error();
    names = ChannelNames(file.value());
    for (std::size_t i = 0; i < file.value().platforms.size(); ++i) {
      names.push_back(kPlatform + std::to_string(i + 1));
    }
  } else {
    const Result<NumericTable> table = ReadNumericTable(choice.file, TableFormat::kStorage, {});
    if (!table.ok()) return table.error();
    names = table.value().names;
  }
  return Error{"select the push by --sensor_column (in a list of sensors by \"column\"): it has " +
                   (names.empty() ? "none" : ListOfNames(names)),
               choice.file};
}

// The mean height of the pressure, weighted by the force, along the file's axis that points up.
std::optional<double> HeightOfPressure(const PlatformRecord& platform, const Eigen::Vector3d& up) {
  double sum = 0.0, weight = 0.0;
  for (std::size_t i = 0; i < platform.force.size(); ++i) {
    if (!platform.centre[i].allFinite()) continue;
    sum += platform.force[i].norm() * platform.centre[i].dot(up);
    weight += platform.force[i].norm();
  }
  return weight > 0.0 ? std::optional<double>(sum / weight) : std::nullopt;
}

Result<SensorRecord> FromC3d(const SensorChoice& choice, const Eigen::Vector3d& up) {
  const Result<C3dFile> read = ReadC3d(choice.file);
  if (!read.ok()) return read.error();
  const C3dFile& file = read.value();
  SensorRecord record;
  if (choice.column.rfind(kPlatform, 0) == 0) {
    std::int64_t number = 0;
    if (!ParseInteger(choice.column.substr(sizeof kPlatform - 1), &number) || number < 1 ||
        number > 1000) {
      return Error{Quoted(choice.column) +
                   " is not a platform; it must be platform:1 or another number"};
    }
    const std::optional<LengthUnit> unit = FromName<LengthUnit>(file.point_unit);
    if (!unit && !Trimmed(file.point_unit).empty()) {
      return Error{"its lengths are in " + Quoted(file.point_unit) +
                       ", which is unknown, so the height of a platform is unknown too",
                   choice.file};
    }
    const Result<PlatformRecord> platform = EvaluatePlatform(
        file, static_cast<int>(number) - 1, unit.value_or(LengthUnit::kMillimetre));
    if (!platform.ok()) return platform.error();
    record.is_vector = true;
    record.force = platform.value().force;
    record.height_m = HeightOfPressure(platform.value(), up);
  } else {
    const int channel = file.FindAnalog(choice.column);
    if (channel < 0) {
      return NoColumn(choice, "analog channel", ChannelNames(file));
    }
    for (double sample : file.analog[channel].samples) record.force.push_back({sample, 0.0, 0.0});
  }
  for (std::size_t i = 0; i < record.force.size(); ++i) {
    record.time_s.push_back(static_cast<double>(i) / file.analog_rate_hz);
    if (!record.force[i].allFinite()) {
      return Error{choice.column + " is not finite at sample " + std::to_string(i), choice.file};
    }
  }
  return record;
}

}  // namespace

void FillFromMotion(const RecordedPerson& person, SensorChoice* choice) {
  std::error_code failed;
  if (!std::filesystem::equivalent(person.file, choice->file, failed) || failed) return;
  if (!choice->start_s) choice->start_s = person.file_clock_s;
  if (!choice->up.empty() || !choice->forward.empty()) return;
  choice->up = person.file_up;
  choice->forward = person.file_forward;
}

Result<SensorRecord> ReadSensor(const SensorChoice& choice) {
  const Result<Eigen::Matrix3d> rotation = AxesRotation(
      choice.up.empty() ? "z" : choice.up, choice.forward.empty() ? "x" : choice.forward);
  if (!rotation.ok()) return rotation.error();
  const MotionFormat format = MotionFormatOfFile(choice.file).value_or(MotionFormat::kCsv);
  const bool several = format == MotionFormat::kC3d || format == MotionFormat::kStorage;
  if (choice.column.empty() && several) return WhichColumn(choice, format);
  if (!std::isfinite(choice.gain) || choice.gain == 0.0) {
    return Error{"the gain of a sensor must be a number of N per unit other than 0"};
  }
  Result<SensorRecord> record = format == MotionFormat::kC3d
                                    ? FromC3d(choice, rotation.value().row(2).transpose())
                                : choice.column.empty() ? ReadSensorCsv(choice.file)
                                                        : FromTable(choice);
  if (!record.ok()) return record;
  record.value().file = choice.file;
  if (choice.zero_n.value_or(0.0) != 0.0 && record.value().is_vector) {
    return Error{"an offset can only be subtracted from a sensor with a single axis", choice.file};
  }
  for (Eigen::Vector3d& force : record.value().force) {
    force *= choice.gain;
    force.x() -= choice.zero_n.value_or(0.0);
    if (record.value().is_vector) force = rotation.value() * force;
  }
  if (!choice.zero_n) SubtractRest(&record.value());
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
    if (fields.Has("zero")) sensor.zero_n = fields.Number("zero", "what it reads at rest in N");
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
