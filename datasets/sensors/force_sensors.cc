// datasets: force sensors in any file, lists of them, and force platforms.
#include "datasets/sensors/force_sensors.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "datasets/files/json_file.h"
#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "datasets/files/numeric_table.h"
#include "datasets/formats/c3d.h"
#include "datasets/formats/motion_formats.h"
#include "datasets/formats/units.h"
#include "datasets/manifest/manifest.h"

namespace pushid {
namespace {

using Eigen::Vector3d;
using Vector6 = Eigen::Matrix<double, 6, 1>;

// Metres in the length of a moment's unit ("Nmm", "N.m", "N*cm"), else in `unit`.
double MomentLength(const std::string& text, LengthUnit unit) {
  std::string letters;
  for (char c : text) {
    if ((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z')) letters += c;
  }
  for (const LengthUnitRow& row : kLengthUnits) {
    if (EqualsIgnoringCase(letters, std::string("N") + row.name)) return MetresPer(row.value);
  }
  return MetresPer(unit);
}

class Platform {
 public:
  Platform(const C3dFile& file, const C3dPlatform& platform, LengthUnit unit)
      : file_(file), platform_(platform), metres_(MetresPer(unit)) {
    origin_ = metres_ * platform.origin;
    if (origin_.z() > 0.0) origin_.z() = -origin_.z();
    moment_metres_ = MomentLength(file.analog[platform.channels[5]].unit, unit);
    Baseline();
  }

  // Axes and centre; false when the corners span nothing.
  bool Place() {
    const auto corner = [this](int i) -> Vector3d { return metres_ * platform_.corners.col(i); };
    centre_ = 0.25 * (corner(0) + corner(1) + corner(2) + corner(3));
    const Vector3d x = corner(0) - corner(1), y = corner(0) - corner(3);
    const Vector3d z = x.cross(y);
    if (!(x.norm() > 1e-6 && y.norm() > 1e-6 && z.norm() > 1e-3 * x.norm() * y.norm())) {
      return false;
    }
    axes_.col(0) = x.normalized();
    axes_.col(2) = z.normalized();
    axes_.col(1) = axes_.col(2).cross(axes_.col(0));
    return true;
  }

  PlatformRecord Record() const {
    PlatformRecord record;
    record.rate_hz = file_.analog_rate_hz;
    record.normal = -axes_.col(2);
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    const std::size_t samples = file_.analog[platform_.channels[0]].samples.size();
    Vector3d impulse = Vector3d::Zero();
    for (std::size_t i = 0; i < samples; ++i) {
      Vector3d force, centre;  // in the platform's axes; the centre on its surface
      double free_moment = 0.0;
      Sample(i, &force, &centre, &free_moment);
      const bool pressed = std::fabs(force.z()) >= kPressed && centre.allFinite();
      record.force.push_back(axes_ * force);
      record.centre.push_back(pressed ? Vector3d(centre_ + axes_ * centre)
                                      : Vector3d::Constant(kNaN));
      // About z, which points inwards.
      record.free_moment.push_back(pressed ? -free_moment : 0.0);
      impulse += record.force.back();
    }
    if (impulse.dot(record.normal) < 0.0) {
      for (Vector3d& force : record.force) force = -force;
      for (double& moment : record.free_moment) moment = -moment;
    }
    return record;
  }

 private:
  double Raw(int channel, std::size_t sample) const {
    return file_.analog[platform_.channels[channel]].samples[sample] - baseline_[channel];
  }

  // The mean of the frames without load, where the file names some.
  void Baseline() {
    baseline_.assign(platform_.channels.size(), 0.0);
    const int first = file_.platform_zero_first, last = file_.platform_zero_last;
    if (first < 1 || last < first || last > file_.num_frames()) return;
    const int per_frame = file_.samples_per_frame();
    for (std::size_t c = 0; c < baseline_.size(); ++c) {
      const std::vector<double>& samples = file_.analog[platform_.channels[c]].samples;
      double sum = 0.0;
      for (int i = (first - 1) * per_frame; i < last * per_frame; ++i) sum += samples[i];
      baseline_[c] = sum / ((last - first + 1) * per_frame);
    }
  }

  // Force and moment at the centre of the surface, platform axes (types 2 to 4).
  void Wrench(std::size_t i, Vector3d* force, Vector3d* moment) const {
    if (platform_.type == 3) {
      const double fx12 = Raw(0, i), fx34 = Raw(1, i), fy14 = Raw(2, i), fy23 = Raw(3, i);
      const double fz1 = Raw(4, i), fz2 = Raw(5, i), fz3 = Raw(6, i), fz4 = Raw(7, i);
      const double a = metres_ * platform_.origin.x(), b = metres_ * platform_.origin.y();
      *force = {fx12 + fx34, fy14 + fy23, fz1 + fz2 + fz3 + fz4};
      const Vector3d at_sensors = {b * (fz1 + fz2 - fz3 - fz4), a * (-fz1 + fz2 + fz3 - fz4),
                                   b * (-fx12 + fx34) + a * (fy14 - fy23)};
      *moment = at_sensors + force->cross(Vector3d(0.0, 0.0, origin_.z()));
      return;
    }
    Vector6 wrench;
    for (int c = 0; c < 6; ++c) wrench[c] = Raw(c, i);
    if (platform_.type == 4) wrench = platform_.calibration * wrench;
    *force = wrench.head<3>();
    *moment = moment_metres_ * wrench.tail<3>() + force->cross(origin_);
  }

  void Sample(std::size_t i, Vector3d* force, Vector3d* centre, double* free_moment) const {
    if (platform_.type == 1) {
      *force = {Raw(0, i), Raw(1, i), Raw(2, i)};
      *centre = {metres_ * Raw(3, i), metres_ * Raw(4, i), 0.0};
      *free_moment = moment_metres_ * Raw(5, i);
      return;
    }
    Vector3d moment;
    Wrench(i, force, &moment);
    const double x = -moment.y() / force->z(), y = moment.x() / force->z();
    *centre = {x, y, 0.0};
    *free_moment = moment.z() - x * force->y() + y * force->x();
  }

  const C3dFile& file_;
  const C3dPlatform& platform_;
  double metres_, moment_metres_ = 1.0;
  Vector3d origin_, centre_;
  Eigen::Matrix3d axes_;
  std::vector<double> baseline_;  // per channel
};

}  // namespace

Result<PlatformRecord> EvaluatePlatform(const C3dFile& file, int platform, LengthUnit unit) {
  const int count = static_cast<int>(file.platforms.size());
  if (platform < 0 || platform >= count) {
    return Error{"there is no force platform " + std::to_string(platform + 1) + "; the file has " +
                     std::to_string(count),
                 file.path};
  }
  Platform evaluated(file, file.platforms[platform], unit);
  if (!evaluated.Place()) {
    return Error{
        "the corners of force platform " + std::to_string(platform + 1) + " span no surface",
        file.path};
  }
  return evaluated.Record();
}

namespace {

constexpr char kPlatform[] = "platform:";

std::vector<std::string> ChannelNames(const C3dFile& file) {
  std::vector<std::string> names;
  for (const C3dAnalogChannel& channel : file.analog) names.push_back(channel.name);
  return names;
}

// The column of this name, or the three whose common part it is; empty: none.
std::vector<int> ColumnsCalled(const std::string& name, const std::vector<std::string>& names) {
  const auto same = std::find(names.begin(), names.end(), name);
  if (same != names.end()) return {static_cast<int>(same - names.begin())};
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
        return UnknownNameError(choice.file, "column", names, choice.column);
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
      return UnknownNameError(choice.file, "analog channel", ChannelNames(file), choice.column);
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

}  // namespace pushid
