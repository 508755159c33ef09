// apps: pushid-push: the push of a recording that has none, by inverse dynamics or from a sensor.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/flags/command_line.h"
#include "apps/flags/push_flags.h"
#include "apps/flags/recording_flags.h"
#include "apps/sensor_push.h"
#include "datasets/files/number_text.h"
#include "datasets/formats/push_csv.h"
#include "datasets/manifest/recording_names.h"
#include "ident/push/push_estimation.h"

namespace {

using namespace pushid;

// What the two ways have in common.
struct MadePush {
  Push push;
  PushKind kind;
  std::string how;
};

// As the manifest needs it: relative to its folder.
std::string PathFromManifest(const std::string& file) {
  namespace fs = std::filesystem;
  std::error_code failed;
  const fs::path folder = fs::absolute(RecordingFlagsFromCommandLine().manifest).parent_path();
  const fs::path path = fs::proximate(fs::absolute(file), folder, failed);
  return failed ? fs::absolute(file).string() : path.string();
}

Result<MadePush> FromSensor(const PushFlags& flags, const Recording& recorded,
                            const PendulumRecording& recording) {
  const Result<SensorPush> made = PushFromSensors(flags.sensor, recorded, recording, flags.person);
  if (!made.ok()) return made.error();
  for (const std::string& warning : made.value().warnings) Warn(warning);
  return MadePush{made.value().push, PushKind::kExternal, made.value().how};
}

Result<MadePush> ByInverseDynamics(const PushFlags& flags, const PendulumRecording& recording) {
  PushEstimationOptions options;
  options.person = flags.person;
  options.smoothing_frames = flags.smoothing;
  if (flags.smoothing > recording.num_frames()) {
    return Error{"--smoothing is longer than recording " + recording.id + ", which has " +
                 std::to_string(recording.num_frames()) + " frames"};
  }
  PushWindow window = flags.window;
  if (window.start < 0 || window.end < 0) {
    const Result<PushWindow> found = DetectPushWindow(recording, options);
    if (!found.ok()) return found.error();
    if (window.start < 0) window.start = found.value().start;
    if (window.end < 0) window.end = found.value().end;
  }
  const Result<EstimatedPush> push = EstimatePush(recording, window, options);
  if (!push.ok()) return push.error();
  for (int t = window.start; t < window.end; ++t) {
    if (recording.Weight(flags.person, t) > 0.0) continue;
    Warn("hip or ankles are not seen at frame " + std::to_string(t) +
         " of the push: the force there is that of interpolated positions");
    break;
  }
  return MadePush{
      push.value().push, push.value().kind,
      "by inverse dynamics, " +
          (flags.smoothing > 0 ? "smoothed over " + std::to_string(flags.smoothing) + " frames"
                               : std::string("unsmoothed"))};
}

void PrintPush(const MadePush& made, double dt, const std::string& file) {
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
      file.c_str());
  std::printf("  \"push_kind\": \"%s\",\n", Name(made.kind).c_str());
  std::printf("  \"pushes\": [{\"person\": %d, \"csv\": %s, \"start_frame\": %d}]\n",
              made.push.person, nlohmann::json(PathFromManifest(file)).dump().c_str(),
              made.push.start_frame);
}

int Run() {
  const Result<PushFlags> read = PushFlagsFromCommandLine();
  if (!read.ok()) return Fail(read.error());
  const PushFlags& flags = read.value();
  const Result<std::vector<Recording>> recordings = LoadFlaggedRecordings({flags.id});
  if (!recordings.ok()) return Fail(recordings.error());
  const PendulumRecording recording =
      MakePendulumRecording(recordings.value().front(), SkeletonMapping::kExact);
  const Result<MadePush> made = flags.sensor.sensors.empty()
                                    ? ByInverseDynamics(flags, recording)
                                    : FromSensor(flags, recordings.value().front(), recording);
  if (!made.ok()) return Fail(made.error());
  if (MaybeError error = WritePushCsv(flags.out, made.value().push.force)) return Fail(*error);
  PrintPush(made.value(), recording.scene.dt, flags.out);
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
