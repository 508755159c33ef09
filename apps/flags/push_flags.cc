// apps: pushid-push by flag.
#include "apps/flags/push_flags.h"

#include <gflags/gflags.h>

#include <algorithm>

#include "apps/flags/command_line.h"
#include "apps/flags/overwrite_flag.h"
#include "apps/flags/recording_flags.h"
#include "datasets/files/atomic_file.h"
#include "datasets/manifest/recording.h"
#include "datasets/manifest/select_recordings.h"

namespace {
constexpr char kAuto[] = "auto";
}

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

DEFINE_string(initial_velocity, kAuto,
              "inverse dynamics: velocity of the person at the start of the window: zero, "
              "estimated, or auto (estimated where the hip moves faster than 0.1 m/s)");

namespace pushid {
namespace {

constexpr char kPlace[] = "{id}";  // in --out and --sensor

std::string WithId(std::string path, const std::string& id) {
  const size_t at = path.find(kPlace);
  return at == std::string::npos ? path : path.replace(at, sizeof kPlace - 1, id);
}

bool HasPlace(const std::string& path) { return path.find(kPlace) != std::string::npos; }

// A flag of the other way would be taken and do nothing.
MaybeError CheckInverseDynamics() {
  for (const char* flag : {"first_frame", "end_frame", "smoothing", "initial_velocity"}) {
    if (SensorGiven() && Given(flag)) {
      return Error{std::string("--") + flag + " applies to inverse dynamics, not to --sensor"};
    }
  }
  if (FLAGS_first_frame < -1 || FLAGS_end_frame < -1) {
    return Error{"--first_frame and --end_frame are frames, counted from 0"};
  }
  return std::nullopt;
}

// Inputs and outputs of one recording, or of several.
MaybeError CheckRecordings(const PushFlags& flags) {
  const std::vector<std::string>& ids = flags.ids;
  if (ids.size() > 1 && !HasPlace(flags.out)) {
    return Error{"--out needs {id} for " + std::to_string(ids.size()) +
                 " recordings, as in push/{id}.csv"};
  }
  const std::vector<SensorChoice>& sensors = flags.sensor.sensors;
  const bool each_its_own =
      std::all_of(sensors.begin(), sensors.end(),
                  [](const SensorChoice& sensor) { return HasPlace(sensor.file); });
  if (ids.size() > 1 && !each_its_own) {
    return Error{
        "a sensor file belongs to one recording; name it by --id, or put {id} into the sensor's "
        "file, as in force/{id}.csv"};
  }
  const std::string manifest = RecordingFlagsFromCommandLine().manifest;
  if (flags.into_manifest && ManifestPaths(manifest).size() > 1) {
    return Error{"--into_manifest writes into one manifest; --recordings names several"};
  }
  for (const std::string& id : ids) {
    if (MaybeError error = CheckNew("out", flags.OutOf(id))) return error;
    if (HasPlace(flags.out)) {
      if (MaybeError error = MakeFolderOf(flags.OutOf(id))) return error;
    }
    if (MaybeError error = CheckOutputFiles({flags.OutOf(id)})) return error;
  }
  return std::nullopt;
}

}  // namespace

std::string PushFlags::OutOf(const std::string& id) const { return WithId(out, id); }

SensorFlags PushFlags::SensorOf(const std::string& id) const {
  SensorFlags of = sensor;
  for (SensorChoice& choice : of.sensors) choice.file = WithId(choice.file, id);
  return of;
}

Result<PushFlags> PushFlagsFromCommandLine() {
  PushFlags flags;
  flags.ids = FLAGS_id.empty() ? RecordingFlagsFromCommandLine().ids : std::vector{FLAGS_id};
  if (flags.ids.empty())
    return Error{"--id is missing: name a recording of the manifest, or several by --ids"};
  if (MaybeError missing = Require("out", FLAGS_out, "name the CSV file to write")) return *missing;
  if (MaybeError error = CheckInverseDynamics()) return *error;
  if (Given("resample_fps")) {
    return Error{
        "a push has a row for each of the recording's own frames; leave --resample_fps out"};
  }
  const Result<SensorFlags> sensor = SensorFlagsFromCommandLine();
  if (!sensor.ok()) return sensor.error();
  flags.person = FLAGS_person;
  flags.out = FLAGS_out;
  flags.into_manifest = FLAGS_into_manifest;
  flags.overwrite = OverwriteGiven();
  flags.sensor = sensor.value();
  flags.window = {FLAGS_first_frame, FLAGS_end_frame};
  flags.smoothing = FLAGS_smoothing;
  if (FLAGS_initial_velocity != kAuto) {
    flags.initial_velocity = InitialVelocityFromName(FLAGS_initial_velocity);
    if (!flags.initial_velocity || *flags.initial_velocity == InitialVelocity::kFree) {
      return Error{"--initial_velocity is '" + FLAGS_initial_velocity +
                   "'; it must be zero, estimated or auto"};
    }
  }
  if (MaybeError error = CheckRecordings(flags)) return *error;
  return flags;
}

}  // namespace pushid
