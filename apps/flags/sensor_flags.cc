// apps: pushes from force sensors.
#include "apps/flags/sensor_flags.h"

#include <gflags/gflags.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "apps/support/app_support.h"
#include "apps/support/overwrite_check.h"
#include "datasets/files/number_text.h"
#include "ident/push/sensor_offset.h"

DEFINE_string(sensor, "",
              "force sensor: CSV file time,force or time,fx,fy,fz (s, N); any CSV, STO, MOT or C3D "
              "with --sensor_column");
DEFINE_string(sensors, "", "several force sensors that push together: a JSON list, see README");
DEFINE_string(sensor_column, "",
              "force sensor: the column, the common part of three (ground_force_v), the analog "
              "channel, or platform:1");
DEFINE_double(sensor_gain, 1.0, "force sensor: N per unit of the column");
DEFINE_string(
    sensor_up, "",
    "force sensor: its axis that points up, for vectors; empty: that of the motion when it "
    "is the same file, otherwise z");
DEFINE_double(sensor_zero, 0.0,
              "force sensor: what it reads at rest, in N, taken off; for sensors of one number");
DEFINE_string(sensor_forward, "",
              "force sensor: its axis that points forward, for vectors; empty: that of the motion, "
              "or x");
DEFINE_string(direction, "1,0,0", "force sensor: direction of the force on the person, x,y,z");
DEFINE_double(height, 1.0, "force sensor: contact height as a fraction of the rod (1: the hip)");
DEFINE_double(height_m, 0.0,
              "force sensor: contact height in m above the recording's zero instead");
DEFINE_double(sensor_start, 0.0,
              "force sensor: its clock at frame 0, s; unless given, that of the motion when it is "
              "the same file, otherwise 0");
DEFINE_double(idle_force, 0.0, "force sensor: forces up to this many N are idling");
DEFINE_bool(estimate_offset, false,
            "force sensors: estimate how far their clocks are off from the motion");
DEFINE_double(max_offset_s, 0.5, "how far --estimate_offset looks on either side, s");

namespace pushid {
namespace {

constexpr const char* kOfOneSensor[] = {
    "sensor_zero", "sensor_column", "sensor_gain", "sensor_up",    "sensor_forward",
    "direction",   "height",        "height_m",    "sensor_start", "idle_force"};

Result<std::vector<SensorChoice>> SensorsFromFlags() {
  if (!FLAGS_sensors.empty()) return ReadSensorList(FLAGS_sensors);
  SensorChoice sensor;
  sensor.file = FLAGS_sensor;
  sensor.column = FLAGS_sensor_column;
  sensor.gain = FLAGS_sensor_gain;
  sensor.zero_n = FLAGS_sensor_zero;
  sensor.up = FLAGS_sensor_up;
  sensor.forward = FLAGS_sensor_forward;
  sensor.height_fraction = FLAGS_height;
  if (Given("height_m")) sensor.height_m = FLAGS_height_m;
  if (Given("sensor_start")) sensor.start_s = FLAGS_sensor_start;
  sensor.idle_force = FLAGS_idle_force;
  std::istringstream text(FLAGS_direction);
  char comma1 = 0, comma2 = 0, rest = 0;
  Eigen::Vector3d& d = sensor.direction;
  if (!(text >> d[0] >> comma1 >> d[1] >> comma2 >> d[2]) || comma1 != ',' || comma2 != ',' ||
      text >> rest) {
    return Error{"--direction is '" + FLAGS_direction + "'; it must be x,y,z, as in 1,0,0"};
  }
  return std::vector<SensorChoice>{sensor};
}

constexpr double kOddGain = 3.0;  // beyond what friction and recovery blur

// Rows of several pushes on one person, added frame by frame.
void AddPush(const Push& more, Push* sum) {
  if (sum->force.empty()) {
    *sum = more;
    return;
  }
  const int start = std::min(sum->start_frame, more.start_frame);
  const int end = std::max(sum->EndFrame(), more.EndFrame());
  std::vector<Eigen::Vector4d> force(end - start, Eigen::Vector4d::Zero());
  for (const Push* push : {static_cast<const Push*>(sum), &more}) {
    for (std::size_t i = 0; i < push->force.size(); ++i) {
      force[push->start_frame - start + i] += push->force[i];
    }
  }
  sum->force = std::move(force);
  sum->start_frame = start;
}

// As PushFromSensor takes it, but for the offset: vectors along the direction.
TimedForce AsVectors(const SensorRecord& record, const SensorChoice& sensor) {
  TimedForce timed{record, sensor.start_s.value_or(0.0)};
  if (record.is_vector) return timed;
  const Eigen::Vector3d along = sensor.direction.normalized();
  for (Eigen::Vector3d& force : timed.record.force) force = force.x() * along;
  return timed;
}

}  // namespace

bool SensorGiven() { return !FLAGS_sensor.empty() || !FLAGS_sensors.empty(); }

MaybeError CheckSensorFlags() {
  if (!FLAGS_sensor.empty() && !FLAGS_sensors.empty()) {
    return Error{"give --sensor or --sensors, not both"};
  }
  for (const char* flag : kOfOneSensor) {
    if (FLAGS_sensor.empty() && Given(flag)) {
      return Error{std::string("--") + flag + " needs --sensor: name the file of its forces"};
    }
  }
  for (const char* flag : {"estimate_offset", "max_offset_s"}) {
    if (!SensorGiven() && Given(flag)) {
      return Error{std::string("--") + flag + " needs --sensor or --sensors"};
    }
  }
  if (!(FLAGS_height >= 0.0 && FLAGS_height <= 2.0)) {
    return Error{"--height must be a fraction of the rod between 0 and 2; --height_m takes metres"};
  }
  if (!(FLAGS_height_m >= 0.0 && FLAGS_height_m <= 3.0)) {
    return Error{"--height_m must be a height between 0 and 3 m"};
  }
  if (Given("height") && Given("height_m")) return Error{"give --height or --height_m, not both"};
  if (!(FLAGS_idle_force >= 0.0) || !std::isfinite(FLAGS_idle_force)) {
    return Error{"--idle_force must be a force of at least 0 N"};
  }
  return std::nullopt;
}

Result<SensorPush> PushFromSensors(const Recording& recorded, const PendulumRecording& recording,
                                   int person) {
  Result<std::vector<SensorChoice>> sensors = SensorsFromFlags();
  if (!sensors.ok()) return sensors.error();
  SensorPush result;
  std::vector<SensorRecord> records;
  std::vector<TimedForce> timed;
  for (SensorChoice& sensor : sensors.value()) {
    if (MaybeError error = CheckNoOutput("--sensors", sensor.file)) return *error;
    for (const RecordedPerson& one : recorded.people) FillFromMotion(one, &sensor);
    Result<SensorRecord> record = ReadSensor(sensor);
    if (!record.ok()) return record.error();
    timed.push_back(AsVectors(record.value(), sensor));
    records.push_back(std::move(record.value()));
  }
  result.how = records.size() == 1 ? "from the sensor, averaged over the frames"
                                   : "from " + std::to_string(records.size()) +
                                         " sensors together, averaged over the frames";
  for (const SensorChoice& sensor : sensors.value()) {
    if (!sensor.start_s || Given("sensor_start") || !FLAGS_sensors.empty()) continue;
    result.how +=
        "; recorded with the motion, its clock at frame 0 is " + Rounded(*sensor.start_s, 4) + " s";
  }
  double offset_s = 0.0, clock_error_s = 0.0;
  if (FLAGS_estimate_offset) {
    const Result<SensorOffset> offset =
        EstimateSensorOffset(timed, recording, person, FLAGS_max_offset_s);
    if (!offset.ok()) return offset.error();
    offset_s = offset.value().offset_s;
    clock_error_s = 0.5 * recording.scene.dt + 2.0 * offset.value().standard_error_s;
    const double gain = offset.value().gain;
    if (gain < 1.0 / kOddGain || gain > kOddGain) {
      result.warnings.push_back("the motion fits " + Rounded(gain, 2) +
                                " times the force best: check its unit and gain, and the mass");
    }
    result.how += "; clock at frame 0 moved by " + Rounded(offset_s, 4) + " +- " +
                  Rounded(offset.value().standard_error_s, 2) + " s (estimated)";
  }
  for (std::size_t i = 0; i < records.size(); ++i) {
    const SensorChoice& sensor = sensors.value()[i];
    SensorPushOptions options;
    options.person = person;
    options.direction = sensor.direction;
    options.height_fraction = sensor.height_fraction;
    options.height_m = sensor.height_m ? sensor.height_m : records[i].height_m;
    options.clock_error_s = clock_error_s;
    options.frame_zero_time_s = sensor.start_s.value_or(0.0) + offset_s;
    options.idle_force = sensor.idle_force;
    const Result<Push> push = PushFromSensor(records[i], recording, options);
    if (!push.ok()) return push.error();
    if (records[i].height_m && *records[i].height_m < 0.1) {
      result.warnings.push_back(sensor.file + ": " + sensor.column +
                                " lies on the floor: what it measures is the ground's force on "
                                "the person who stands there, which is no push");
    }
    AddPush(push.value(), &result.push);
  }
  return result;
}

}  // namespace pushid
