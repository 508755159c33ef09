// apps: pushid-push: the push of a recording that has none, by inverse dynamics or from a sensor.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/flags/command_line.h"
#include "apps/flags/push_flags.h"
#include "apps/flags/recording_flags.h"
#include "datasets/files/number_text.h"
#include "datasets/formats/force_csv.h"
#include "datasets/inspection/findings.h"
#include "datasets/manifest/recording.h"
#include "ident/push/push_estimation.h"

namespace {

using namespace pushid;

// What the two ways have in common.
struct MadePush {
  Push push;
  PushKind kind;
  std::string how;
  double start_speed = 0.0;  // m/s; inverse dynamics only
};

struct RecordingsPush {
  std::string id, file;
  MadePush made;
};

// As the manifest needs it: relative to its folder.
std::string PathFromManifest(const std::string& file) {
  namespace fs = std::filesystem;
  std::error_code failed;
  const fs::path folder = fs::absolute(RecordingFlagsFromCommandLine().manifest).parent_path();
  const fs::path path = fs::proximate(fs::absolute(file), folder, failed);
  return failed ? fs::absolute(file).string() : path.string();
}

MadePush FromSensor(const PushFlags& flags, const Recording& recorded,
                    const PendulumRecording& recording) {
  const SensorSetup setup = flags.SensorOf(recorded.id);
  for (const SensorChoice& sensor : setup.sensors) {
    OrFail(OutputFiles().CheckNotRead("--sensors", sensor.file));
  }
  const SensorPush made = OrFail(PushFromSensors(setup, recorded, recording, flags.person));
  for (const std::string& warning : made.warnings) Warn(warning);
  return MadePush{made.push, PushKind::kExternal, made.how};
}

MadePush ByInverseDynamics(const PushFlags& flags, const PendulumRecording& recording) {
  const PushEstimationOptions options{flags.person, flags.smoothing, flags.initial_velocity};
  if (flags.smoothing > recording.num_frames()) {
    throw Error{"--smoothing is longer than recording " + recording.id + ", which has " +
                std::to_string(recording.num_frames()) + " frames"};
  }
  const PushWindow window = OrFail(PushWindowFrom(flags.window, recording, options));
  const EstimatedPush push = OrFail(EstimatePush(recording, window, options));
  for (int t = window.start; t < window.end; ++t) {
    if (recording.Weight(flags.person, t) > 0.0) continue;
    Warn("hip or ankles are missing at frame " + std::to_string(t) +
         " of the push: the force there is computed from interpolated positions");
    break;
  }
  return MadePush{
      push.push, push.kind,
      "by inverse dynamics, " +
          (flags.smoothing > 0 ? "smoothed over " + std::to_string(flags.smoothing) + " frames"
                               : std::string("unsmoothed")),
      push.start_speed};
}

void WarnOfFirstRow(const std::string& id, const MadePush& made) {
  if (!FirstRowStandsOut(made.push.force)) return;
  const std::string force = Rounded(made.push.force[0].head<2>().norm(), 3);
  Warn("recording " + id + ": the first row, " + force +
       " N, stands out: the person already moves when the window begins; begin earlier "
       "(--first_frame), or set --initial_velocity=estimated" +
       (made.push.start_frame == 0 ? " in the manifest" : ""));
}

void PrintPush(const RecordingsPush& of, double dt) {
  const MadePush& made = of.made;
  Vector4<double> impulse = Vector4<double>::Zero();
  double peak = 0.0;
  for (const Eigen::Vector4d& row : made.push.force) {
    impulse += dt * row;
    peak = std::max(peak, row.head<2>().norm());
  }
  std::printf("%s: push on person %d, %d rows from frame %d, %s\n", of.id.c_str(), made.push.person,
              made.push.EndFrame() - made.push.start_frame, made.push.start_frame,
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
    Warn("recording " + of.id +
         ": the push is sideways rather than forwards; check `up` and `forward` in the manifest");
  }
  std::printf("written to %s\n", of.file.c_str());
}

void PrintEntry(const RecordingsPush& of) {
  std::printf(
      "to use it, add these lines to the recording's entry of the manifest, in place of any "
      "push_csv (--into_manifest does this):\n");
  std::printf("  \"push_kind\": \"%s\",\n", NameOf(of.made.kind).c_str());
  std::printf("  \"pushes\": [{\"person\": %d, \"csv\": %s, \"start_frame\": %d}]\n",
              of.made.push.person, nlohmann::json(PathFromManifest(of.file)).dump().c_str(),
              of.made.push.start_frame);
}

// The push in the place of what the entry says of pushes on this person.
void SetPush(const RecordingsPush& of, bool overwrite, ManifestRecording* entry) {
  const int person = of.made.push.person;
  std::string there = entry->pushed_person == person ? entry->push_csv : "";
  std::vector<ManifestPush> others;
  for (const ManifestPush& push : entry->pushes) {
    if (push.person != person) others.push_back(push);
    if (push.person == person) there = push.csv;
  }
  const auto where = [&](const std::string& what) {
    return Error{"recording " + of.id + " " + what, entry->manifest, entry->line};
  };
  if (!there.empty() && !overwrite) {
    throw where("has a push on person " + std::to_string(person) + " already, " + there +
                "; --overwrite replaces it");
  }
  const bool others_stay = !others.empty() || (there.empty() && !entry->push_csv.empty());
  if (others_stay && entry->push_kind != of.made.kind) {
    throw where("has pushes on other people of the kind " + NameOf(entry->push_kind) +
                ", and this one is " + NameOf(of.made.kind) + "; an entry can have only one kind");
  }
  if (entry->pushed_person == person) entry->push_csv.clear();
  entry->pushes = std::move(others);
  entry->pushes.push_back({person, PathFromManifest(of.file), of.made.push.start_frame});
  entry->push_kind = of.made.kind;
}

Manifest WithPushes(const std::vector<RecordingsPush>& pushes, bool overwrite) {
  Manifest manifest = OrFail(FlaggedManifest());
  for (ManifestRecording& entry : manifest.recordings) {
    for (const RecordingsPush& push : pushes) {
      if (push.id != entry.id) continue;
      SetPush(push, overwrite, &entry);
    }
  }
  return manifest;
}

int Run() {
  const PushFlags flags = PushFlagsFromCommandLine();
  const std::vector<Recording> recordings = LoadFlaggedRecordings(flags.ids);
  std::vector<RecordingsPush> pushes;
  std::vector<Finding> findings;
  for (const Recording& recorded : recordings) {
    const PendulumRecording recording = MakePendulumRecording(recorded, SkeletonMapping::kExact);
    const MadePush made = flags.sensor.sensors.empty() ? ByInverseDynamics(flags, recording)
                                                       : FromSensor(flags, recorded, recording);
    WarnOfFirstRow(recorded.id, made);
    Recording pushed = recorded;
    pushed.pushes = {made.push};
    pushed.push_kind = made.kind;
    for (Finding& finding : FindingsOf(pushed)) findings.push_back(std::move(finding));
    pushes.push_back({recorded.id, flags.OutOf(recorded.id), made});
  }
  for (const std::string& warning : FindingTexts(FitFindings(std::move(findings)))) Warn(warning);
  // Every refusal comes before the first file is written.
  Manifest manifest;
  if (flags.into_manifest) manifest = WithPushes(pushes, flags.overwrite);
  for (size_t i = 0; i < pushes.size(); ++i) {
    OrFail(WritePushCsv(pushes[i].file, pushes[i].made.push.force));
    PrintPush(pushes[i], 1.0 / recordings[i].fps);
    if (!flags.into_manifest) PrintEntry(pushes[i]);
  }
  if (!flags.into_manifest) return kDone;
  OrFail(WriteManifest(manifest.path, manifest));
  std::printf("%zu %s written to %s\n", pushes.size(), pushes.size() == 1 ? "entry" : "entries",
              manifest.path.c_str());
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  return pushid::RunApp(argc, argv,
                        "pushid-push computes the push of a recording: by inverse dynamics over a "
                        "window of its motion, or from a measured force.\n\n"
                        "  pushid-push --recordings=M/manifest.json --id=NAME --out=push.csv\n"
                        "  pushid-push --recordings=M/manifest.json --id=NAME --sensor=force.csv "
                        "--height=0.9 --out=push.csv\n"
                        "  pushid-push --recordings=M/manifest.json --id=NAME --sensor=trial.c3d "
                        "--sensor_column=platform:1 --estimate_offset --out=push.csv",
                        Run);
}
