// datasets: force sensors in any file, and lists of them.
#include "datasets/sensors/sensor_choice.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "datasets/files/json_file.h"
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

// The error for files that hold more than a push.
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

constexpr double kLeastRest = 0.1;    // s before the pull
constexpr double kMargin = 0.02;      // s before it that do not count: it begins softly
constexpr double kPullBegins = 0.05;  // of the peak
constexpr double kNoiseOfPull = 5.0;  // standard deviations
constexpr double kLoad = 0.3;         // of the peak
constexpr double kSurely = 4.0;       // standard errors of the reading
constexpr double kWorthwhile = 1e-3;  // of the peak
constexpr int kFewestAtRest = 5, kSustained = 3;

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// The median of the first samples, and the standard deviation about it of their largest component.
Eigen::Vector3d ReadingOf(const SensorRecord& record, int samples, double* noise) {
  Eigen::Vector3d reading;
  *noise = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (int i = 0; i < samples; ++i) values.push_back(record.force[i][axis]);
    reading[axis] = Median(values);
    double squares = 0.0;
    for (double value : values) squares += (value - reading[axis]) * (value - reading[axis]);
    *noise = std::max(*noise, std::sqrt(squares / samples));
  }
  return reading;
}

// The last sample before which nobody pulls, judged from a first guess of the reading.
int SamplesAtRest(const SensorRecord& record, const Eigen::Vector3d& guess, double noise,
                  double peak) {
  const double pull = std::max(kPullBegins * peak, kNoiseOfPull * noise);
  int sustained = 0;
  for (int i = 0; i < record.num_samples(); ++i) {
    sustained = (record.force[i] - guess).norm() > pull ? sustained + 1 : 0;
    if (sustained < kSustained) continue;
    const double until = record.time_s[i - kSustained + 1] - kMargin;
    return static_cast<int>(std::lower_bound(record.time_s.begin(), record.time_s.end(), until) -
                            record.time_s.begin());
  }
  return 0;
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

void SubtractRest(SensorRecord* record) {
  const std::vector<double>& time = record->time_s;
  const auto first = static_cast<int>(
      std::upper_bound(time.begin(), time.end(), time.front() + kLeastRest) - time.begin());
  if (first < kFewestAtRest || first == record->num_samples()) return;
  double noise = 0.0, peak = 0.0;
  const Eigen::Vector3d guess = ReadingOf(*record, first, &noise);
  for (const Eigen::Vector3d& force : record->force) peak = std::max(peak, (force - guess).norm());
  const int samples = SamplesAtRest(*record, guess, noise, peak);
  if (samples < kFewestAtRest || time[samples - 1] - time[0] < kLeastRest - kMargin) return;
  const Eigen::Vector3d rest = ReadingOf(*record, samples, &noise);
  if (!(rest.norm() < kLoad * peak)) return;
  record->noise = noise;
  if (rest.norm() < std::max(kSurely * noise / std::sqrt(samples), kWorthwhile * peak)) return;
  record->subtracted = rest;
  for (Eigen::Vector3d& force : record->force) force -= rest;
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
