// apps: pushid-push: the push of a recording that has none, by inverse dynamics or from a sensor.
#include <cmath>
#include <map>
#include <optional>
#include <sstream>

#include "apps/flags/command_line.h"
#include "apps/flags/overwrite_flag.h"
#include "apps/flags/recording_flags.h"
#include "datasets/files/json_file.h"
#include "datasets/formats/force_csv.h"
#include "datasets/inspection/findings.h"
#include "datasets/manifest/recording.h"
#include "ident/push/push_estimation.h"

DEFINE_string(id, "", "the recording, or several by --ids; default: all that --setting selects");
DEFINE_int32(person, 0,
             "number of the pushed person, counted from 0; default: the manifest's pushed_person");
DEFINE_string(out, "", "write the push here (CSV); {id} is replaced by the recording's id");
DEFINE_bool(update, false, "write the push's entry into the manifest");

DEFINE_string(frames, "",
              "inverse dynamics: the window, its first frame and the frame after it, as in 25:40; "
              "default: detected");

DEFINE_string(sensor, "",
              "force sensor: CSV file time,force or time,fx,fy,fz (s, N); any CSV, STO, MOT or C3D "
              "with --sensor_column; or, for several sensors or further "
              "properties, a JSON list (datasets/README.md)");
DEFINE_string(sensor_column, "",
              "force sensor: the column, the common part of three (ground_force_v), the analog "
              "channel, or platform:1");
DEFINE_string(direction, "1,0,0", "force sensor: direction of the force on the person, x,y,z");
DEFINE_double(height, pushid::SensorChoice{}.height_fraction,
              "force sensor: contact height as a fraction of the rod (1: the hip); default: the "
              "manifest's push_height_m, or the hip");
DEFINE_double(sensor_start, 0.0,
              "force sensor: its clock at frame 0, s; default: that of the motion if both are in "
              "one file or the record holds half of the recording by it; else both begin at once");

namespace {

using namespace pushid;

// Flags that need more than a look.
struct PushFlags {
  std::vector<std::string> ids;       // the recordings
  std::vector<SensorChoice> sensors;  // that push together; without one, inverse dynamics
  PushWindow window = {-1, -1};       // of inverse dynamics; -1: to be detected
};

bool SensorsListed() { return EndsWith(FLAGS_sensor, ".json"); }

const std::vector<std::string> kOfOneSensor = {"sensor_column", "direction", "height",
                                               "sensor_start"};

std::vector<SensorChoice> SensorsFromFlags() {
  if (SensorsListed()) return OrFail(ReadSensorList(FLAGS_sensor));
  SensorChoice sensor;
  sensor.file = FLAGS_sensor;
  sensor.column = FLAGS_sensor_column;
  sensor.height_fraction = FLAGS_height;
  if (Given("sensor_start")) sensor.start_s = FLAGS_sensor_start;
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
  if (FLAGS_sensor.empty()) {
    RefuseGiven(kOfOneSensor, " needs --sensor: name the file of its forces");
  }
  if (SensorsListed()) {
    RefuseGiven(kOfOneSensor, " is given in the list, " + FLAGS_sensor + "; leave it out");
  }
  CheckRange("height", FLAGS_height, 0, 2);
}

constexpr char kPlace[] = "{id}";  // in --out and --sensor

std::string WithId(std::string path, const std::string& id) {
  const size_t at = path.find(kPlace);
  return at == std::string::npos ? path : path.replace(at, sizeof kPlace - 1, id);
}

bool HasPlace(const std::string& path) { return path.find(kPlace) != std::string::npos; }

std::string OutOf(const std::string& id) { return WithId(FLAGS_out, id); }

// Inputs and outputs of one recording, or of several.
void CheckRecordings(const PushFlags& flags) {
  const std::vector<std::string>& ids = flags.ids;
  if (ids.size() > 1 && !HasPlace(FLAGS_out)) {
    throw Error{"--out needs {id} for " + std::to_string(ids.size()) +
                " recordings, as in push/{id}.csv"};
  }
  const bool each_its_own =
      std::all_of(flags.sensors.begin(), flags.sensors.end(),
                  [](const SensorChoice& sensor) { return HasPlace(sensor.file); });
  if (ids.size() > 1 && !each_its_own) {
    throw Error{
        "a sensor file belongs to one recording; name it by --id, or put {id} into the sensor's "
        "file, as in force/{id}.csv"};
  }
  if (FLAGS_update && ManifestPaths(FLAGS_recordings).size() > 1) {
    throw Error{"--update writes into one manifest; --recordings names several"};
  }
  for (const std::string& id : ids) {
    OrFail(CheckNew("out", OutOf(id)));
    if (HasPlace(FLAGS_out)) OrFail(MakeFolderOf(OutOf(id)));
    OrFail(CheckOutputFiles({OutOf(id)}));
  }
}

PushFlags PushFlagsFromCommandLine() {
  PushFlags flags;
  flags.ids = FLAGS_id.empty() ? SelectedIds() : std::vector{FLAGS_id};
  Require("out", FLAGS_out, "name the CSV file to write");
  if (!FLAGS_sensor.empty()) {
    RefuseGiven({"frames"}, " applies to inverse dynamics, not to --sensor");
  }
  PushWindow& window = flags.window;
  char rest = 0;
  if (!FLAGS_frames.empty() &&
      (std::sscanf(FLAGS_frames.c_str(), "%d:%d%c", &window.start, &window.end, &rest) != 2 ||
       window.start < 0 || window.end < 0)) {
    throw Error{"--frames is '" + FLAGS_frames + "'; write first:end, counted from 0, as in 25:40"};
  }
  if (Given("resample_fps")) {
    throw Error{
        "a push has a row for each of the recording's own frames; leave --resample_fps out"};
  }
  CheckSensors();
  if (!FLAGS_sensor.empty()) flags.sensors = SensorsFromFlags();
  CheckRecordings(flags);
  return flags;
}

// A recording's push by a sensor or by inverse dynamics.
struct MadePush {
  std::string id, file;  // of the recording, and to write
  Push push;
  PushKind kind;
  std::string how;
  double start_speed = 0.0;  // m/s; inverse dynamics only
};

int PushedPerson(const Recording& recorded) {
  return Given("person") ? FLAGS_person : recorded.pushed_person;
}

// push_height_m: that of the recording's entry, which --height and a list of sensors replace.
MadePush FromSensor(const PushFlags& flags, const Recording& recorded,
                    const PendulumRecording& recording,
                    const std::optional<double>& push_height_m) {
  std::vector<SensorChoice> sensors = flags.sensors;
  for (SensorChoice& sensor : sensors) {
    sensor.file = WithId(sensor.file, recorded.id);
    if (!SensorsListed() && !Given("height")) sensor.height_m = push_height_m;
    OrFail(CheckNotRead("--sensor", sensor.file));
  }
  const SensorPush made =
      OrFail(PushFromSensors(sensors, recorded, recording, PushedPerson(recorded)));
  for (const std::string& warning : made.warnings) LOG(WARNING) << warning;
  return {recorded.id, OutOf(recorded.id), made.push, PushKind::kExternal, made.how};
}

MadePush ByInverseDynamics(const PushFlags& flags, int person, const PendulumRecording& recording) {
  constexpr int kSmoothing = 9;  // frames; unsmoothed, 2 mm of noise cause 600 N
  const PushEstimationOptions options{person, kSmoothing};
  if (recording.num_frames() < kSmoothing) {
    throw Error{"recording " + recording.id + " has fewer than " + std::to_string(kSmoothing) +
                " frames, over which a push is smoothed"};
  }
  const PushWindow window = OrFail(DetectPushWindow(recording, options, flags.window));
  const EstimatedPush push = OrFail(EstimatePush(recording, window, options));
  for (int t = window.start; t < window.end; ++t) {
    if (recording.Weight(person, t) > 0.0) continue;
    LOG(WARNING) << "hip or ankles are missing at frame " << std::to_string(t)
                 << " of the push: the force there is computed from interpolated positions";
    break;
  }
  return {recording.id,
          OutOf(recording.id),
          push.push,
          push.kind,
          "by inverse dynamics, smoothed over " + std::to_string(kSmoothing) + " frames",
          push.start_speed};
}

void WarnOfFirstRow(const MadePush& made) {
  if (!FirstRowStandsOut(made.push.force)) return;
  const std::string force = Rounded(made.push.force[0].head<2>().norm(), 3);
  LOG(WARNING) << "recording " << made.id << ": the first row, " << force
               << " N, stands out: the person already moves when the window begins; begin earlier "
                  "(--frames)"
               << (made.push.start_frame == 0 ? ", or set initial_velocity in the manifest" : "");
}

void PrintPush(const MadePush& made, double dt) {
  Vector4<double> impulse = Vector4<double>::Zero();
  double peak = 0.0;
  for (const Eigen::Vector4d& row : made.push.force) {
    impulse += dt * row;
    peak = std::max(peak, row.head<2>().norm());
  }
  std::printf("%s: push on person %d, %d rows from frame %d, %s\n", made.id.c_str(),
              made.push.person, made.push.EndFrame() - made.push.start_frame, made.push.start_frame,
              made.how.c_str());
  if (made.start_speed > 0.0) {
    std::printf("the cart moves at %s m/s at its start\n", Rounded(made.start_speed, 3).c_str());
  }
  const auto towards = [](double part, const char* ahead, const char* back) {
    return Rounded(std::fabs(part), 3) + " N s " + (part < 0.0 ? back : ahead);
  };
  std::printf("impulse %s, %s; peak %s N\n", towards(impulse[0], "forwards", "backwards").c_str(),
              towards(impulse[1], "to the left", "to the right").c_str(), Rounded(peak, 3).c_str());
  if (std::fabs(impulse[1]) > std::fabs(impulse[0])) {
    LOG(WARNING)
        << "recording " << made.id
        << ": the push is sideways rather than forwards; check `up` and `forward` in the manifest";
  }
  std::printf("written to %s\n", made.file.c_str());
}

void PrintEntry(const MadePush& of) {
  std::printf(
      "to use it, add these lines to the recording's entry of the manifest, in place of any "
      "push_csv and push_height_m (--update does this):\n");
  std::printf("  \"push_kind\": \"%s\",\n", NameOf(of.kind).c_str());
  std::printf("  \"pushes\": [{\"person\": %d, \"csv\": %s, \"start_frame\": %d}]\n",
              of.push.person,
              nlohmann::json(PathFromManifest(FLAGS_recordings, of.file)).dump().c_str(),
              of.push.start_frame);
}

// Replaces the entry's push on this person.
void SetPush(const MadePush& of, ManifestRecording* entry) {
  const int person = of.push.person;
  std::string there = entry->pushed_person == person ? entry->push_csv : "";
  std::vector<ManifestPush> others;
  for (const ManifestPush& push : entry->pushes) {
    if (push.person != person) others.push_back(push);
    if (push.person == person) there = push.csv;
  }
  const auto where = [&](const std::string& what) {
    return Error{"recording " + of.id + " " + what, entry->manifest, entry->line};
  };
  if (!there.empty() && !FLAGS_overwrite) {
    throw where("has a push on person " + std::to_string(person) + " already, " + there +
                "; --overwrite replaces it");
  }
  const bool others_stay = !others.empty() || (there.empty() && !entry->push_csv.empty());
  if (others_stay && entry->push_kind != of.kind) {
    throw where("has pushes on other people of the kind " + NameOf(entry->push_kind) +
                ", and this one is " + NameOf(of.kind) + "; an entry can have only one kind");
  }
  if (entry->pushed_person == person) entry->push_csv.clear();
  entry->push_height_m.reset();  // the rows have torques
  entry->pushes = std::move(others);
  entry->pushes.push_back(
      {person, PathFromManifest(FLAGS_recordings, of.file), of.push.start_frame});
  entry->push_kind = of.kind;
}

int Run() {
  const PushFlags flags = PushFlagsFromCommandLine();
  const std::vector<Recording> recordings = LoadFlaggedRecordings(flags.ids);
  Manifest manifest = OrFail(FlaggedManifest());
  std::map<std::string, std::optional<double>> heights;
  for (const ManifestRecording& entry : manifest.recordings) {
    heights[entry.id] = entry.push_height_m;
  }
  std::vector<MadePush> pushes;
  std::vector<Finding> findings;
  for (const Recording& recorded : recordings) {
    const PendulumRecording recording = MakePendulumRecording(recorded);
    const MadePush made = flags.sensors.empty()
                              ? ByInverseDynamics(flags, PushedPerson(recorded), recording)
                              : FromSensor(flags, recorded, recording, heights[recorded.id]);
    WarnOfFirstRow(made);
    Recording pushed = recorded;
    pushed.pushes = {made.push};
    pushed.push_kind = made.kind;
    for (Finding& finding : FindingsOf(MakePendulumRecording(pushed))) {
      findings.push_back(std::move(finding));
    }
    pushes.push_back(made);
  }
  for (const std::string& warning : FindingTexts(findings)) LOG(WARNING) << warning;
  // Everything is checked before the first file is written.
  for (ManifestRecording& entry : manifest.recordings) {
    for (const MadePush& push : pushes) {
      if (FLAGS_update && push.id == entry.id) SetPush(push, &entry);
    }
  }
  for (size_t i = 0; i < pushes.size(); ++i) {
    OrFail(WritePushCsv(pushes[i].file, pushes[i].push.force));
    PrintPush(pushes[i], 1.0 / recordings[i].fps);
    if (!FLAGS_update) PrintEntry(pushes[i]);
  }
  if (!FLAGS_update) return kDone;
  OrFail(WriteManifest(manifest.path, manifest));
  std::printf("%zu %s written to %s\n", pushes.size(), pushes.size() == 1 ? "entry" : "entries",
              manifest.path.c_str());
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  return pushid::RunApp(
      argc, argv,
      "pushid-push computes the push of a recording, by inverse dynamics or from a measured "
      "force.\n"
      "  pushid-push --recordings=recordings/manifest.json --id=S01_00_weak --out=push.csv",
      Run);
}
