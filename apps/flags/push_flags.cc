// apps: pushid-push by flag.
#include "apps/flags/push_flags.h"

#include <gflags/gflags.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "apps/flags/command_line.h"
#include "apps/flags/recording_flags.h"
#include "datasets/files/atomic_file.h"
#include "datasets/manifest/manifest.h"
#include "datasets/manifest/recording.h"

DEFINE_string(id, "", "the recording; or several by --ids");
DEFINE_int32(person, pushid::PushFlags{}.person, "number of the pushed person, counted from 0");
DEFINE_string(out, "", "write the push here (CSV); {id} is replaced by the recording's id");
DEFINE_bool(into_manifest, pushid::PushFlags{}.into_manifest,
            "write the push's entry into the manifest");

DEFINE_int32(first_frame, pushid::PushFlags{}.window.start,
             "inverse dynamics: first frame of the window; -1: detected");
DEFINE_int32(end_frame, pushid::PushFlags{}.window.end,
             "inverse dynamics: frame after the window; -1: detected");
DEFINE_int32(smoothing, pushid::PushFlags{}.smoothing,
             "inverse dynamics: Savitzky-Golay window in frames, odd, at least 5; 0: none (2 mm of "
             "noise then cause 600 N)");

DEFINE_string(initial_velocity, "auto",
              "inverse dynamics: velocity of the person at the start of the window: zero, "
              "estimated, or auto (estimated where the hip moves faster than 0.1 m/s)");

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
DEFINE_double(sensor_zero, 0.0,
              "force sensor: its offset (reading at rest), N, subtracted; default: what it reads "
              "before the pull; 0: keep that");
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
DEFINE_bool(estimate_offset, pushid::SensorSetup{}.estimate_offset,
            "force sensors: estimate the offset of their clocks from the motion's, of people "
            "whose feet move; offsets within their error are zero");
DEFINE_double(max_offset_s, pushid::SensorSetup{}.max_offset_s,
              "search range of --estimate_offset on either side, s");

namespace pushid {
namespace {

bool SensorGiven() { return !FLAGS_sensor.empty() || !FLAGS_sensors.empty(); }

const std::vector<std::string> kOfOneSensor = {
    "sensor_zero", "sensor_column", "sensor_gain", "sensor_up",    "sensor_forward",
    "direction",   "height",        "height_m",    "sensor_start", "idle_force"};

std::vector<SensorChoice> SensorsFromFlags() {
  if (!FLAGS_sensors.empty()) return OrFail(ReadSensorList(FLAGS_sensors));
  SensorChoice sensor;
  sensor.file = FLAGS_sensor;
  sensor.column = FLAGS_sensor_column;
  sensor.gain = FLAGS_sensor_gain;
  if (Given("sensor_zero")) sensor.zero_n = FLAGS_sensor_zero;
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
    throw Error{"--direction is '" + FLAGS_direction + "'; it must be x,y,z, as in 1,0,0"};
  }
  return {sensor};
}

void CheckSensors() {
  CheckExcludes({"sensor"}, "sensors", "give --sensor or --sensors, not both");
  CheckNeeds(kOfOneSensor, {"sensor"}, ": name the file of its forces");
  CheckNeeds({"estimate_offset", "max_offset_s"}, {"sensor", "sensors"});
  if (Given("height") && Given("height_m")) throw Error{"give --height or --height_m, not both"};
  if (!(FLAGS_height >= 0.0 && FLAGS_height <= 2.0)) {
    throw Error{"--height must be a fraction of the rod between 0 and 2; --height_m takes metres"};
  }
  if (!(FLAGS_height_m >= 0.0 && FLAGS_height_m <= 3.0)) {
    throw Error{"--height_m must be a height between 0 and 3 m"};
  }
  if (!(FLAGS_idle_force >= 0.0) || !std::isfinite(FLAGS_idle_force)) {
    throw Error{"--idle_force must be a force of at least 0 N"};
  }
}

SensorSetup SensorsFromCommandLine() {
  CheckSensors();
  SensorSetup flags;
  if (SensorGiven()) {
    flags.sensors = SensorsFromFlags();
  }
  flags.estimate_offset = FLAGS_estimate_offset;
  flags.max_offset_s = FLAGS_max_offset_s;
  return flags;
}

constexpr char kPlace[] = "{id}";  // in --out and --sensor

std::string WithId(std::string path, const std::string& id) {
  const size_t at = path.find(kPlace);
  return at == std::string::npos ? path : path.replace(at, sizeof kPlace - 1, id);
}

bool HasPlace(const std::string& path) { return path.find(kPlace) != std::string::npos; }

// A flag of the other way would be taken and do nothing.
void CheckInverseDynamics() {
  for (const char* flag : {"first_frame", "end_frame", "smoothing", "initial_velocity"}) {
    if (SensorGiven() && Given(flag)) {
      throw Error{std::string("--") + flag + " applies to inverse dynamics, not to --sensor"};
    }
  }
  if (FLAGS_first_frame < -1 || FLAGS_end_frame < -1) {
    throw Error{"--first_frame and --end_frame are frames, counted from 0"};
  }
}

// Inputs and outputs of one recording, or of several.
void CheckRecordings(const PushFlags& flags) {
  const std::vector<std::string>& ids = flags.ids;
  if (ids.size() > 1 && !HasPlace(flags.out)) {
    throw Error{"--out needs {id} for " + std::to_string(ids.size()) +
                " recordings, as in push/{id}.csv"};
  }
  const std::vector<SensorChoice>& sensors = flags.sensor.sensors;
  const bool each_its_own =
      std::all_of(sensors.begin(), sensors.end(),
                  [](const SensorChoice& sensor) { return HasPlace(sensor.file); });
  if (ids.size() > 1 && !each_its_own) {
    throw Error{
        "a sensor file belongs to one recording; name it by --id, or put {id} into the sensor's "
        "file, as in force/{id}.csv"};
  }
  const std::string manifest = RecordingFlagsFromCommandLine().manifest;
  if (flags.into_manifest && ManifestPaths(manifest).size() > 1) {
    throw Error{"--into_manifest writes into one manifest; --recordings names several"};
  }
  for (const std::string& id : ids) {
    OrFail(CheckNew("out", flags.OutOf(id)));
    if (HasPlace(flags.out)) OrFail(MakeFolderOf(flags.OutOf(id)));
    OrFail(CheckOutputFiles({flags.OutOf(id)}));
  }
}

}  // namespace

std::string PushFlags::OutOf(const std::string& id) const { return WithId(out, id); }

SensorSetup PushFlags::SensorOf(const std::string& id) const {
  SensorSetup of = sensor;
  for (SensorChoice& choice : of.sensors) choice.file = WithId(choice.file, id);
  return of;
}

PushFlags PushFlagsFromCommandLine() {
  PushFlags flags;
  flags.ids = FLAGS_id.empty() ? RecordingFlagsFromCommandLine().ids : std::vector{FLAGS_id};
  if (flags.ids.empty())
    throw Error{"--id is missing: name a recording of the manifest, or several by --ids"};
  Require("out", FLAGS_out, "name the CSV file to write");
  CheckInverseDynamics();
  if (Given("resample_fps")) {
    throw Error{
        "a push has a row for each of the recording's own frames; leave --resample_fps out"};
  }
  const SensorSetup sensor = SensorsFromCommandLine();
  flags.person = FLAGS_person;
  flags.out = FLAGS_out;
  flags.into_manifest = FLAGS_into_manifest;
  flags.overwrite = OverwriteGiven();
  flags.sensor = sensor;
  flags.window = {FLAGS_first_frame, FLAGS_end_frame};
  flags.smoothing = FLAGS_smoothing;
  OrFail(
      ParseInitialVelocity("--initial_velocity", FLAGS_initial_velocity, &flags.initial_velocity));
  CheckRecordings(flags);
  return flags;
}

}  // namespace pushid
