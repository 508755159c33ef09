// datasets: force sensors in any file, lists of them, and force platforms.
#include "datasets/sensors/force_sensors.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

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

constexpr char kPlatform[] = "platform:";

// Lengths of platforms, m: beyond them a length is in another unit than the file says.
constexpr double kLeastSide = 0.005, kMostSide = 20.0, kLeastOrigin = 5e-4, kMostOrigin = 2.0;
constexpr double kLeastLever = 1e-3;   // m, from the middle to where people press, at the median
constexpr double kLoadedZero = 200.0;  // N; less may be an offset

class Platform {
 public:
  Platform(const C3dFile& file, int index, LengthUnit unit)
      : file_(file),
        platform_(file.platforms[index]),
        name_(StrCat(kPlatform, index + 1)),
        unit_(unit),
        num_channels_(platform_.type == 3 ? 8 : 6) {}

  // Throws an Error where it cannot be evaluated.
  PlatformRecord Record() {
    Check();
    Place();
    const auto says = [this](const char* name) {
      return file_.parameters.Find("FORCE_PLATFORM", name) != nullptr;
    };
    if (says("TYPE") && !says("USED")) Warn("is counted by TYPE: USED is missing");
    if (says("FPCOPPOLY")) Warn("has FPCOPPOLY, a correction of centres, which is not applied");
    ReadOrigin();
    ReadUnits();
    ReadZero();
    record_.rate_hz = file_.analog_rate_hz;
    record_.normal = -axes_.col(2);
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    Vector3d impulse = Vector3d::Zero();
    int pressed = 0, outside = 0;
    double farthest = 0.0;
    for (std::size_t i = 0; i < num_samples(); ++i) {
      const auto [force, centre] = Sample(i);
      if (!force.allFinite()) {
        throw Error{StrCat(name_, " is not finite at sample ", i), file_.path};
      }
      const bool presses = std::fabs(force.z()) >= kPressed && centre.allFinite();
      record_.force.push_back(axes_ * force);
      record_.centre.push_back(presses ? Vector3d(centre_ + axes_ * centre)
                                       : Vector3d::Constant(kNaN));
      impulse += record_.force.back();
      if (!presses) continue;
      ++pressed;
      const double beyond = (centre.head<2>().cwiseAbs() - half_).maxCoeff();
      outside += beyond > kOffPlate;
      farthest = std::max(farthest, beyond);
    }
    if (2 * outside > pressed) {
      record_.outside = "the centre of pressure of " + name_ + " is up to " + Rounded(farthest, 2) +
                        " m outside of its corners: are the channels' units (" +
                        ListOfNames({units_.begin(), units_.end()}) +
                        "), the corners, or a foot off the platform the reason?";
    }
    if (impulse.dot(record_.normal) < 0.0) {
      for (Vector3d& force : record_.force) force = -force;
    }
    return std::move(record_);
  }

 private:
  std::size_t num_samples() const { return file_.analog[platform_.channels[0]].samples.size(); }
  [[noreturn]] void Fail(const std::string& what) const {
    throw Error{name_ + " " + what, file_.path};
  }
  void Warn(const std::string& what) { record_.warnings.push_back(name_ + " " + what); }

  // Whether it can be evaluated.
  void Check() const {
    const int type = platform_.type, channels = static_cast<int>(file_.analog.size());
    if (type == 0) Fail("has no TYPE; types 1 to 4 are known");
    if (type < 1 || type > 4) Fail(StrCat("has the TYPE ", type, "; types 1 to 4 are known"));
    if (static_cast<int>(platform_.channels.size()) < num_channels_) {
      Fail(StrCat("has ", platform_.channels.size(), " of ", num_channels_, " channels (CHANNEL)"));
    }
    for (int c = 0; c < num_channels_; ++c) {
      const int channel = platform_.channels[c];
      if (channel >= 0 && channel < channels) continue;
      Fail(StrCat("names channel ", channel + 1, " (CHANNEL); the file has ",
                  channels == 0 ? "no analog channels" : StrCat("1 to ", channels)));
    }
    const Vector3d& origin = platform_.origin;
    if (!platform_.corners.allFinite()) Fail("has no CORNERS");
    if (type == 3 && !(origin.allFinite() && origin.x() != 0.0 && origin.y() != 0.0)) {
      Fail("has no distances of its sensors, a and b (ORIGIN)");
    }
    if (type == 4 && !platform_.calibration.allFinite()) Fail("has no CAL_MATRIX");
  }

  // Sets axes and centre by the corners.
  void Place() {
    const Eigen::Matrix<double, 3, 4> corners = MetresPer(unit_) * platform_.corners;
    centre_ = corners.rowwise().mean();
    const Vector3d x = corners.col(0) - corners.col(1), y = corners.col(0) - corners.col(3);
    const Vector3d z = x.cross(y);
    half_ = {0.5 * x.norm(), 0.5 * y.norm()};
    if (!(z.norm() > 1e-3 * x.norm() * y.norm())) Fail("has CORNERS that span no surface");
    if (2.0 * half_.minCoeff() < kLeastSide || 2.0 * half_.maxCoeff() > kMostSide) {
      Fail("has CORNERS of " + Rounded(x.norm(), 3) + " by " + Rounded(y.norm(), 3) +
           " m: are they in POINT:UNITS, " + Quoted(file_.point_unit) + "?");
    }
    axes_.col(0) = x.normalized();
    axes_.col(2) = z.normalized();
    axes_.col(1) = axes_.col(2).cross(axes_.col(0));
  }

  void ReadOrigin() {
    origin_.setZero();
    if (platform_.type == 1) return;
    if (!platform_.origin.allFinite()) {
      return Warn("has no ORIGIN: centres are off by its sensors' depth times shear over load");
    }
    origin_ = MetresPer(unit_) * platform_.origin;
    const double size = origin_.norm();
    if (size > 0.0 && (size < kLeastOrigin || size > kMostOrigin)) {
      Warn("has an ORIGIN of " + Rounded(size, 3) + " m: is it in POINT:UNITS, " +
           Quoted(file_.point_unit) + "?");
    }
    if (origin_.z() > 0.0) origin_ = -origin_;
    if (platform_.type != 3) return;
    places_ = origin_.head<2>().cwiseAbs();
    origin_.head<2>().setZero();
  }

  // SI units in one of each channel, after the calibration.
  void ReadUnits() {
    std::set<std::string> unknown;
    std::vector<int> levers;
    for (int c = 0; c < num_channels_; ++c) {
      const std::string& text = file_.analog[platform_.channels[c]].unit;
      const bool force = platform_.type == 3 || c < 3, length = platform_.type == 1 && c < 5;
      const std::optional<double> si =
          force && platform_.type == 4 ? 1.0
                                       : NewtonsIn(length && !force ? "N" + text : text, !force);
      scale_[c] = si.value_or(1.0);
      if (!si && !force) levers.push_back(c);
      units_.insert(text.empty() ? "none" : text);
      if (!si && !text.empty() && platform_.type != 4) unknown.insert(text);
    }
    const LengthUnit unit = levers.empty() ? unit_ : UnitOfLevers();
    for (int c : levers) scale_[c] = MetresPer(unit);
    if (unknown.empty() && unit == unit_) return;
    Warn("has channels " +
         (unknown.empty()
              ? (platform_.type == 4 ? "whose CAL_MATRIX names no unit" : "without a unit")
              : "in " + ListOfNames({unknown.begin(), unknown.end()})) +
         " (ANALOG:UNITS), which are read as N" + (levers.empty() ? "" : " and N " + NameOf(unit)) +
         (unit == unit_ ? "" : ": N " + NameOf(unit_) + " gives no centre of pressure on it"));
  }

  // The file's unit of length, unless people would stand off the platform or always at its middle.
  LengthUnit UnitOfLevers() const {
    std::vector<double> levers;
    for (std::size_t i = 0; i < num_samples(); ++i) {
      const Vector6 read = Read(i);
      const double lever =
          read.segment<2>(3).norm() / (platform_.type == 1 ? 1.0 : std::fabs(read[2]));
      if (std::fabs(read[2]) >= kPressed && std::isfinite(lever)) levers.push_back(lever);
    }
    const double lever = levers.empty() ? 0.0 : UpperMedian(std::move(levers));
    for (LengthUnit unit : {unit_, LengthUnit::kMillimetre, LengthUnit::kMetre}) {
      const double length = lever * MetresPer(unit);
      if (length >= kLeastLever && length <= half_.norm()) return unit;
    }
    return unit_;
  }

  // The mean of the frames without load is taken off, where the file names some.
  void ReadZero() {
    const int first = file_.platform_zero_first, last = file_.platform_zero_last;
    if (last < 1) return;
    const std::string zero = StrCat("has the ZERO frames ", first, " to ", last);
    if (first < 1 || last < first || last > file_.num_frames()) {
      return Warn(StrCat(zero, ", which the file, 1 to ", file_.num_frames(),
                         ", does not have: nothing is taken off, and an offset moves its centre"));
    }
    const std::size_t per_frame = file_.samples_per_frame();
    Eigen::Matrix<double, 8, 1> baseline = Eigen::Matrix<double, 8, 1>::Zero();
    const double share = 1.0 / ((last - first + 1.0) * static_cast<double>(per_frame));
    double load = 0.0, least = 0.0, most = 0.0;  // N, vertical; shares of it more than it
    for (std::size_t i = (first - 1) * per_frame; i < last * per_frame; ++i) {
      baseline += share * Raw(i);
      load += share * Read(i)[2];
    }
    for (std::size_t i = 0; i < num_samples(); ++i) {
      const double part = (Read(i)[2] - load) / load;
      least = std::min(least, part);
      most = std::max(most, part);
    }
    // A person who stood there stays or leaves; an offset stays while somebody comes.
    const bool stays = std::max(-least, most) < 0.5, leaves = std::fabs(least + 1.0) < 0.2;
    if (std::fabs(load) > kLoadedZero && (stays || leaves)) {
      return Warn(zero + ", in which it is loaded with " + Rounded(std::fabs(load), 3) +
                  " N: nothing is taken off");
    }
    baseline_ = baseline;
  }

  Eigen::Matrix<double, 8, 1> Raw(std::size_t i) const {
    Eigen::Matrix<double, 8, 1> raw = -baseline_;
    for (int c = 0; c < num_channels_; ++c)
      raw[c] += file_.analog[platform_.channels[c]].samples[i];
    return raw;
  }

  // Force and moment at the sensors; of type 1 centre and free moment behind the force.
  Vector6 Read(std::size_t i) const {
    const Eigen::Matrix<double, 8, 1> raw = Raw(i);
    if (platform_.type != 3) {
      return scale_.head<6>().cwiseProduct(platform_.calibration * raw.head<6>());
    }
    const Eigen::Matrix<double, 8, 1> f = scale_.cwiseProduct(raw);
    const double a = places_.x(), b = places_.y();
    Vector6 read;
    read << f[0] + f[1], f[2] + f[3], f.tail<4>().sum(), b * (f[4] + f[5] - f[6] - f[7]),
        a * (-f[4] + f[5] + f[6] - f[7]), b * (-f[0] + f[1]) + a * (f[2] - f[3]);
    return read;
  }

  // Force and centre of pressure, on the surface, in the platform's axes.
  std::pair<Vector3d, Vector3d> Sample(std::size_t i) const {
    const Vector6 read = Read(i);
    const Vector3d force = read.head<3>();
    if (platform_.type == 1) return {force, {read[3], read[4], 0.0}};
    const Vector3d moment = read.tail<3>() + force.cross(origin_);
    return {force, {-moment.y() / force.z(), moment.x() / force.z(), 0.0}};
  }

  const C3dFile& file_;
  const C3dPlatform& platform_;
  const std::string name_;
  const LengthUnit unit_;
  const int num_channels_;
  PlatformRecord record_;
  std::set<std::string> units_;  // as the file has them
  Vector3d origin_, centre_;
  Eigen::Vector2d half_, places_;  // of the sides; of the sensors of type 3, a and b
  Eigen::Matrix3d axes_;
  Eigen::Matrix<double, 8, 1> baseline_ = Eigen::Matrix<double, 8, 1>::Zero();
  Eigen::Matrix<double, 8, 1> scale_ = Eigen::Matrix<double, 8, 1>::Ones();
};

}  // namespace

std::optional<double> NewtonsIn(std::string_view unit, bool moment) {
  constexpr std::pair<std::string_view, double> kForces[] = {{"N", 1.0},       {"Newton", 1.0},
                                                             {"Newtons", 1.0}, {"kN", 1e3},
                                                             {"lbf", 4.44822}, {"kgf", 9.80665}};
  std::string letters;
  std::copy_if(unit.begin(), unit.end(), std::back_inserter(letters),
               [](unsigned char c) { return std::isalpha(c) != 0; });
  for (const auto& [name, newtons] : kForces) {
    if (!EqualsIgnoringCase(letters.substr(0, name.size()), name)) continue;
    const std::string rest = letters.substr(name.size());
    const std::optional<LengthUnit> length = FromName<LengthUnit>(rest);
    if (moment && length) return newtons * MetresPer(*length);
    if (!moment && rest.empty()) return newtons;
  }
  return std::nullopt;
}

double NewtonsInColumn(const std::string& name) {
  const std::size_t open = name.find_last_of("([");
  if (open == std::string::npos) return 1.0;
  const std::size_t end = name.find_first_of(",)]", open);
  return NewtonsIn(std::string_view(name).substr(open + 1, end - open - 1)).value_or(1.0);
}

Result<PlatformRecord> EvaluatePlatform(const C3dFile& file, int platform, LengthUnit unit) {
  const int count = static_cast<int>(file.platforms.size());
  if (platform < 0 || platform >= count) {
    return Error{StrCat("there is no force platform ", platform + 1, "; the file has ", count),
                 file.path};
  }
  return Caught([&] { return Platform(file, platform, unit).Record(); });
}

namespace {

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
SensorRecord FromTable(const SensorChoice& choice) {
  double newtons = 1.0;
  const TimedColumns table =
      ReadTimedColumns(choice.file, [&](const std::vector<std::string>& names) {
        const std::vector<int> columns = ColumnsCalled(choice.column, names);
        if (columns.empty()) throw UnknownNameError(choice.file, "column", names, choice.column);
        if (!choice.gain) newtons = NewtonsInColumn(names[columns[0]]);
        return columns;
      });
  SensorRecord record;
  record.is_vector = table.values.size() == 3;
  for (int row = 0; row < table.num_rows(); ++row) {
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < table.values.size(); ++i) force[i] = newtons * table.values[i][row];
    if (!force.allFinite()) {
      throw Error{choice.column + " is missing; fill the gap or cut the record there", choice.file,
                  table.lines[row]};
    }
    record.time_s.push_back(table.first_s + row / table.rate_hz);
    record.force.push_back(force);
  }
  return record;
}

// The error for files that hold more than a push.
Error ColumnError(const SensorChoice& choice, MotionFormat format) {
  std::vector<std::string> names;
  if (format == MotionFormat::kC3d) {
    const C3dFile file = OrThrow(ReadC3d(choice.file));
    names = ChannelNames(file);
    for (std::size_t i = 0; i < file.platforms.size(); ++i) {
      names.push_back(StrCat(kPlatform, i + 1));
    }
  } else {
    names = OrThrow(ReadNumericTable(choice.file, TableFormat::kStorage)).names;
  }
  return {"select the push by --sensor_column (in a list of sensors by \"column\"): it has " +
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

void TakePlatform(const C3dFile& file, const SensorChoice& choice, const Eigen::Vector3d& up,
                  SensorRecord* record, std::vector<std::string>* warnings) {
  std::int64_t number = 0;
  if (!ParseInteger(choice.column.substr(sizeof kPlatform - 1), &number) || number < 1 ||
      number > 1000) {
    throw Error{Quoted(choice.column) +
                " is not a platform; it must be platform:1 or another number"};
  }
  const std::optional<LengthUnit> unit = FromName<LengthUnit>(file.point_unit);
  if (!unit && !Trimmed(file.point_unit).empty()) {
    throw Error{"its lengths are in " + Quoted(file.point_unit) +
                    ", which is unknown, so the height of a platform is unknown too",
                choice.file};
  }
  PlatformRecord platform = OrThrow(
      EvaluatePlatform(file, static_cast<int>(number) - 1, unit.value_or(LengthUnit::kMillimetre)));
  if (!platform.outside.empty()) platform.warnings.push_back(platform.outside);
  if (warnings != nullptr) {
    warnings->insert(warnings->end(), platform.warnings.begin(), platform.warnings.end());
  }
  record->is_vector = true;
  record->height_m = HeightOfPressure(platform, up);
  record->force = std::move(platform.force);
}

SensorRecord FromC3d(const SensorChoice& choice, const Eigen::Vector3d& up,
                     std::vector<std::string>* warnings) {
  const C3dFile file = OrThrow(ReadC3d(choice.file));
  SensorRecord record;
  if (choice.column.rfind(kPlatform, 0) == 0) {
    TakePlatform(file, choice, up, &record, warnings);
  } else {
    const std::vector<std::string> names = ChannelNames(file);
    const auto found = std::find(names.begin(), names.end(), choice.column);
    if (found == names.end()) {
      throw UnknownNameError(choice.file, "analog channel", names, choice.column);
    }
    const C3dAnalogChannel& channel = file.analog[found - names.begin()];
    const std::string& unit = channel.unit;
    const std::optional<double> newtons = choice.gain || unit.empty() ? 1.0 : NewtonsIn(unit);
    if (!newtons) {
      throw Error{choice.column + " is in " + Quoted(unit) +
                      " (ANALOG:UNITS): give its \"gain\", in N per unit, in a list of sensors",
                  choice.file};
    }
    for (double sample : channel.samples) {
      record.force.push_back({*newtons * sample, 0.0, 0.0});
    }
  }
  for (std::size_t i = 0; i < record.force.size(); ++i) {
    record.time_s.push_back(static_cast<double>(i) / file.analog_rate_hz);
    if (record.force[i].allFinite()) continue;
    throw Error{StrCat(choice.column, " is not finite at sample ", i), choice.file};
  }
  return record;
}

constexpr double kLeastRest = 0.1;    // s before the pull
constexpr double kMargin = 0.02;      // s before it that do not count: it begins softly
constexpr double kPullBegins = 0.05;  // of the peak
constexpr double kNoiseOfPull = 5.0;  // standard deviations
constexpr double kLoad = 0.3;         // of the peak
constexpr double kSurely = 4.0;       // standard errors of the reading
constexpr double kWorthwhile = 1e-3;  // of the peak
constexpr int kFewestAtRest = 5, kSustained = 3;

// The median of the first samples, and the standard deviation about it of their largest component.
Eigen::Vector3d ReadingOf(const SensorRecord& record, int samples, double* noise) {
  Eigen::Vector3d reading;
  *noise = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (int i = 0; i < samples; ++i) values.push_back(record.force[i][axis]);
    reading[axis] = UpperMedian(values);
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

Result<SensorRecord> ReadSensor(const SensorChoice& choice, std::vector<std::string>* warnings) {
  return Caught([&] {
    const Eigen::Matrix3d rotation = AxesGiven(choice.up, choice.forward);
    const MotionFormat format = MotionFormatOfFile(choice.file).value_or(MotionFormat::kCsv);
    const bool several = format == MotionFormat::kC3d || format == MotionFormat::kStorage;
    if (choice.column.empty() && several) throw ColumnError(choice, format);
    const double gain = choice.gain.value_or(1.0), zero_n = choice.zero_n.value_or(0.0);
    if (!std::isfinite(gain) || gain == 0.0) {
      throw Error{"the gain of a sensor must be a number of N per unit other than 0"};
    }
    SensorRecord record = format == MotionFormat::kC3d
                              ? FromC3d(choice, rotation.row(2).transpose(), warnings)
                          : choice.column.empty() ? OrThrow(ReadSensorCsv(choice.file))
                                                  : FromTable(choice);
    record.file = choice.file;
    if (zero_n != 0.0 && record.is_vector) {
      throw Error{"an offset can only be subtracted from a sensor with a single axis", choice.file};
    }
    for (Eigen::Vector3d& force : record.force) {
      force *= gain;
      force.x() -= zero_n;
      if (record.is_vector) force = rotation * force;
    }
    if (!choice.zero_n) SubtractRest(&record);
    return record;
  });
}

Result<std::vector<SensorChoice>> ReadSensorList(const std::string& path) {
  return Caught([&] {
    const JsonDocument document = OrThrow(ReadJsonDocument(path));
    if (!document.content.is_array() || document.content.empty()) {
      throw document.ErrorAt("", "a list of sensors is expected, [{\"file\": ...}, ...]");
    }
    std::vector<SensorChoice> sensors;
    for (const auto& item : document.content) {
      const std::string index = std::to_string(sensors.size());
      JsonFields fields(document, item, "/" + index, "sensor " + index);
      SensorChoice& sensor = sensors.emplace_back();
      sensor.file = ResolvePath(path, fields.Text("file", "the name of a file with forces"));
      sensor.column = fields.OptionalText("column", "");
      sensor.gain = fields.NumberIfAny("gain", "the N per unit");
      sensor.up = fields.OptionalText("up", "");
      sensor.forward = fields.OptionalText("forward", "");
      if (fields.Has("direction")) {
        const auto xyz = ListOf<double>(fields.At("direction"));
        if (xyz && xyz->size() == 3) {
          sensor.direction = Eigen::Vector3d(xyz->data());
        } else {
          fields.Fail("direction",
                      "must be [x, y, z], as in [1, 0, 0], not " + Shown(fields.At("direction")));
        }
      }
      sensor.height_fraction = fields.OptionalNumber("height", "a fraction of the rod", 1.0);
      sensor.height_m = fields.NumberIfAny("height_m", "a height in m");
      if (fields.Has("height") && fields.Has("height_m")) {
        fields.Fail("height", "is given together with height_m; give one of them");
      }
      sensor.start_s = fields.NumberIfAny("start", "its clock at frame 0 in s");
      sensor.idle_force = fields.OptionalNumber("idle_force", "a force in N", 0.0);
      sensor.zero_n = fields.NumberIfAny("zero", "what it reads at rest in N");
      if (!fields.error() && !(sensor.idle_force >= 0.0)) {
        fields.Fail("idle_force", "must be a force of at least 0 N");
      }
      fields.OnlyAsked();
      OrThrow(fields.error());
    }
    return sensors;
  });
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
