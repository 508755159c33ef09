// apps: pushid-push: the push of a recording that has none, by inverse dynamics or from a sensor.
#include <gflags/gflags.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "apps/app_support.h"
#include "apps/recording_flags.h"
#include "datasets/atomic_file.h"
#include "datasets/push_csv.h"
#include "datasets/recording_names.h"
#include "datasets/sensor_csv.h"
#include "ident/push_estimation.h"
#include "ident/push_from_sensor.h"
#include "ident/report_text.h"

DEFINE_string(id, "", "the recording");
DEFINE_int32(person, 0, "who is pushed, counted from 0");
DEFINE_string(out, "", "write the push here (CSV)");

DEFINE_int32(first_frame, -1, "inverse dynamics: first frame of the window; -1: found by itself");
DEFINE_int32(end_frame, -1, "inverse dynamics: frame after the window; -1: found by itself");
DEFINE_int32(smoothing, 9,
             "inverse dynamics: Savitzky-Golay window in frames, odd, at least 5; 0: none (2 mm of "
             "noise then make 600 N)");

DEFINE_string(sensor, "", "force sensor: CSV file time,force or time,fx,fy,fz (s, N)");
DEFINE_string(direction, "1,0,0", "force sensor: direction of the force on the person, x,y,z");
DEFINE_double(height, 1.0, "force sensor: contact height as a fraction of the rod (1: the hip)");
DEFINE_double(height_m, 0.0,
              "force sensor: contact height in m above the recording's zero instead");
DEFINE_double(sensor_start, 0.0, "force sensor: its clock at frame 0, s");
DEFINE_double(idle_force, 0.0, "force sensor: forces up to this many N are idling");

namespace {

using namespace pushid;

// What the two ways have in common.
struct MadePush {
  Push push;
  PushKind kind;
  std::string how;
};

bool Given(const char* flag) { return !gflags::GetCommandLineFlagInfoOrDie(flag).is_default; }

// A flag of the other way would be taken and do nothing.
MaybeError CheckFlags() {
  const bool sensor = !FLAGS_sensor.empty();
  for (const char* flag : {"first_frame", "end_frame", "smoothing"}) {
    if (sensor && Given(flag)) {
      return Error{std::string("--") + flag + " belongs to inverse dynamics, not to --sensor"};
    }
  }
  for (const char* flag : {"direction", "height", "height_m", "sensor_start", "idle_force"}) {
    if (!sensor && Given(flag)) {
      return Error{std::string("--") + flag + " needs --sensor: name the file of its forces"};
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
  if (FLAGS_first_frame < -1 || FLAGS_end_frame < -1) {
    return Error{"--first_frame and --end_frame are frames, counted from 0"};
  }
  return std::nullopt;
}

// As the manifest needs it: relative to its folder.
std::string PathFromManifest(const std::string& file) {
  namespace fs = std::filesystem;
  std::error_code failed;
  const fs::path folder = fs::absolute(FLAGS_recordings).parent_path();
  const fs::path path = fs::proximate(fs::absolute(file), folder, failed);
  return failed ? fs::absolute(file).string() : path.string();
}

Result<MadePush> FromSensor(const PendulumRecording& recording) {
  const Result<SensorRecord> record = ReadSensorCsv(FLAGS_sensor);
  if (!record.ok()) return record.error();
  SensorPushOptions options;
  options.person = FLAGS_person;
  options.height_fraction = FLAGS_height;
  if (Given("height_m")) options.height_m = FLAGS_height_m;
  options.frame_zero_time_s = FLAGS_sensor_start;
  options.idle_force = FLAGS_idle_force;
  std::istringstream text(FLAGS_direction);
  char comma1 = 0, comma2 = 0, rest = 0;
  Vector3<double>& d = options.direction;
  if (!(text >> d[0] >> comma1 >> d[1] >> comma2 >> d[2]) || comma1 != ',' || comma2 != ',' ||
      text >> rest) {
    return Error{"--direction is '" + FLAGS_direction + "'; it must be x,y,z, as in 1,0,0"};
  }
  const Result<Push> push = PushFromSensor(record.value(), recording, options);
  if (!push.ok()) return push.error();
  return MadePush{push.value(), PushKind::kExternal, "from the sensor, averaged over the frames"};
}

Result<MadePush> ByInverseDynamics(const PendulumRecording& recording) {
  PushEstimationOptions options;
  options.person = FLAGS_person;
  options.smoothing_frames = FLAGS_smoothing;
  if (FLAGS_smoothing > recording.num_frames()) {
    return Error{"--smoothing is longer than recording " + recording.id + ", which has " +
                 std::to_string(recording.num_frames()) + " frames"};
  }
  PushWindow window{FLAGS_first_frame, FLAGS_end_frame};
  if (window.start < 0 || window.end < 0) {
    const Result<PushWindow> found = DetectPushWindow(recording, options);
    if (!found.ok()) return found.error();
    if (window.start < 0) window.start = found.value().start;
    if (window.end < 0) window.end = found.value().end;
  }
  const Result<EstimatedPush> push = EstimatePush(recording, window, options);
  if (!push.ok()) return push.error();
  return MadePush{
      push.value().push, push.value().kind,
      "by inverse dynamics, " +
          (FLAGS_smoothing > 0 ? "smoothed over " + std::to_string(FLAGS_smoothing) + " frames"
                               : std::string("unsmoothed"))};
}

void PrintPush(const MadePush& made, double dt) {
  Vector4<double> impulse = Vector4<double>::Zero();
  double peak = 0.0;
  for (const Eigen::Vector4d& row : made.push.force) {
    impulse += dt * row;
    peak = std::max(peak, row.head<2>().norm());
  }
  std::printf("push on person %d, %d rows from frame %d, %s\n", made.push.person,
              made.push.EndFrame() - made.push.start_frame, made.push.start_frame,
              made.how.c_str());
  std::printf("impulse %s N s forwards, %s N s to the left; peak %s N\n",
              Significant(impulse[0], 3).c_str(), Significant(impulse[1], 3).c_str(),
              Significant(peak, 3).c_str());
  std::printf(
      "written to %s; in the recording's entry of the manifest put, instead of any push_csv:\n",
      FLAGS_out.c_str());
  std::printf("  \"push_kind\": \"%s\",\n", Name(made.kind).c_str());
  std::printf("  \"pushes\": [{\"person\": %d, \"csv\": %s, \"start_frame\": %d}]\n",
              made.push.person, nlohmann::json(PathFromManifest(FLAGS_out)).dump().c_str(),
              made.push.start_frame);
}

int Run() {
  if (MaybeError missing = Require("id", FLAGS_id, "name a recording of the manifest")) {
    return Fail(*missing);
  }
  if (MaybeError missing = Require("out", FLAGS_out, "name the CSV file to write")) {
    return Fail(*missing);
  }
  if (MaybeError error = CheckFlags()) return Fail(*error);
  if (MaybeError error = CheckWritable(FLAGS_out)) return Fail(*error);
  const Result<std::vector<Recording>> recordings = LoadFlaggedRecordings({FLAGS_id});
  if (!recordings.ok()) return Fail(recordings.error());
  const PendulumRecording recording =
      MakePendulumRecording(recordings.value().front(), SkeletonMapping::kExact);
  const Result<MadePush> made =
      FLAGS_sensor.empty() ? ByInverseDynamics(recording) : FromSensor(recording);
  if (!made.ok()) return Fail(made.error());
  if (MaybeError error = WritePushCsv(FLAGS_out, made.value().push.force)) return Fail(*error);
  PrintPush(made.value(), recording.scene.dt);
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  return pushid::RunApp(
      argc, argv,
      "pushid-push finds the push of a recording: by inverse dynamics over a window "
      "of its motion, or from a measured force.\n\n  pushid-push "
      "--recordings=M/manifest.json --id=NAME --out=push.csv\n  pushid-push "
      "--recordings=M/manifest.json --id=NAME --sensor=force.csv --height=0.9 "
      "--out=push.csv",
      Run);
}
