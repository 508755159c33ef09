// apps: pushid-push: the push of a recording that has none, by inverse dynamics or from a sensor.
#include <gflags/gflags.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/flags/recording_flags.h"
#include "apps/flags/sensor_flags.h"
#include "apps/support/app_support.h"
#include "datasets/files/atomic_file.h"
#include "datasets/files/number_text.h"
#include "datasets/formats/push_csv.h"
#include "datasets/manifest/recording_names.h"
#include "ident/push/push_estimation.h"

DEFINE_string(id, "", "the recording");
DEFINE_int32(person, 0, "who is pushed, counted from 0");
DEFINE_string(out, "", "write the push here (CSV)");

DEFINE_int32(first_frame, -1, "inverse dynamics: first frame of the window; -1: found by itself");
DEFINE_int32(end_frame, -1, "inverse dynamics: frame after the window; -1: found by itself");
DEFINE_int32(smoothing, 9,
             "inverse dynamics: Savitzky-Golay window in frames, odd, at least 5; 0: none (2 mm of "
             "noise then make 600 N)");

namespace {

using namespace pushid;

// What the two ways have in common.
struct MadePush {
  Push push;
  PushKind kind;
  std::string how;
};

// A flag of the other way would be taken and do nothing.
MaybeError CheckFlags() {
  for (const char* flag : {"first_frame", "end_frame", "smoothing"}) {
    if (SensorGiven() && Given(flag)) {
      return Error{std::string("--") + flag + " belongs to inverse dynamics, not to --sensor"};
    }
  }
  if (FLAGS_first_frame < -1 || FLAGS_end_frame < -1) {
    return Error{"--first_frame and --end_frame are frames, counted from 0"};
  }
  if (Given("resample_fps")) {
    return Error{
        "a push has a row for each of the recording's own frames; leave --resample_fps out"};
  }
  return CheckSensorFlags();
}

// As the manifest needs it: relative to its folder.
std::string PathFromManifest(const std::string& file) {
  namespace fs = std::filesystem;
  std::error_code failed;
  const fs::path folder = fs::absolute(FLAGS_recordings).parent_path();
  const fs::path path = fs::proximate(fs::absolute(file), folder, failed);
  return failed ? fs::absolute(file).string() : path.string();
}

Result<MadePush> FromSensor(const Recording& recorded, const PendulumRecording& recording) {
  const Result<SensorPush> made = PushFromSensors(recorded, recording, FLAGS_person);
  if (!made.ok()) return made.error();
  for (const std::string& warning : made.value().warnings) Warn(warning);
  return MadePush{made.value().push, PushKind::kExternal, made.value().how};
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
  for (int t = window.start; t < window.end; ++t) {
    if (recording.Weight(FLAGS_person, t) > 0.0) continue;
    Warn("hip or ankles are not seen at frame " + std::to_string(t) +
         " of the push: it leans on positions drawn as a straight line");
    break;
  }
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
              Rounded(impulse[0], 3).c_str(), Rounded(impulse[1], 3).c_str(),
              Rounded(peak, 3).c_str());
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
  const Result<MadePush> made = SensorGiven() ? FromSensor(recordings.value().front(), recording)
                                              : ByInverseDynamics(recording);
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
      "--out=push.csv\n  pushid-push --recordings=M/manifest.json --id=NAME --sensor=trial.c3d "
      "--sensor_column=platform:1 --estimate_offset --out=push.csv",
      Run);
}
