// apps: force sensors by flag.
#include "apps/flags/sensor_flags.h"

#include <gflags/gflags.h>

#include <cmath>
#include <sstream>

#include "apps/flags/command_line.h"

DEFINE_string(sensor, "",
              "force sensor: CSV file time,force or time,fx,fy,fz (s, N); any CSV, STO, MOT or C3D "
              "with --sensor_column");
DEFINE_string(sensors, "",
              "several force sensors that act together: a JSON list, see datasets/README.md");
DEFINE_string(sensor_column, "",
              "force sensor: the column, the common part of three (ground_force_v), the analog "
              "channel, or platform:1");
DEFINE_double(sensor_gain, pushid::SensorChoice{}.gain, "force sensor: N per unit of the column");
DEFINE_string(
    sensor_up, "",
    "force sensor: its axis that points up, for vectors; empty: that of the motion when it "
    "is the same file, otherwise z");
DEFINE_double(sensor_zero, pushid::SensorChoice{}.zero_n,
              "force sensor: offset (reading at rest), N, subtracted; for single-axis sensors");
DEFINE_string(sensor_forward, "",
              "force sensor: its axis that points forward, for vectors; empty: that of the motion, "
              "or x");
DEFINE_string(direction, "1,0,0", "force sensor: direction of the force on the person, x,y,z");
DEFINE_double(height, pushid::SensorChoice{}.height_fraction,
              "force sensor: contact height as a fraction of the rod (1: the hip)");
DEFINE_double(height_m, 0.0,
              "force sensor: contact height in m above the recording's zero, instead of --height");
DEFINE_double(sensor_start, 0.0,
              "force sensor: its clock at frame 0, s; default: that of the motion if both are in "
              "one file, otherwise 0");
DEFINE_double(idle_force, pushid::SensorChoice{}.idle_force,
              "force sensor: forces up to this value, N, do not count as a push");
DEFINE_bool(estimate_offset, pushid::SensorFlags{}.estimate_offset,
            "force sensors: estimate the offset of their clocks from the motion's");
DEFINE_double(max_offset_s, pushid::SensorFlags{}.max_offset_s,
              "search range of --estimate_offset on either side, s");

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

}  // namespace

bool SensorGiven() { return !FLAGS_sensor.empty() || !FLAGS_sensors.empty(); }

Result<SensorFlags> SensorFlagsFromCommandLine() {
  if (MaybeError error = CheckSensorFlags()) return *error;
  SensorFlags flags;
  if (SensorGiven()) {
    Result<std::vector<SensorChoice>> sensors = SensorsFromFlags();
    if (!sensors.ok()) return sensors.error();
    flags.sensors = std::move(sensors.value());
  }
  flags.start_given = Given("sensor_start") || !FLAGS_sensors.empty();
  flags.estimate_offset = FLAGS_estimate_offset;
  flags.max_offset_s = FLAGS_max_offset_s;
  return flags;
}

}  // namespace pushid
