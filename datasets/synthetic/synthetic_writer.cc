// datasets: synthetic recordings as files, through the writers that users have.
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "datasets/files/atomic_file.h"
#include "datasets/files/number_text.h"
#include "datasets/formats/force_csv.h"
#include "datasets/manifest/manifest.h"
#include "datasets/synthetic/synthetic_recordings.h"

namespace pushid {
namespace {

constexpr LengthUnit kUnit = LengthUnit::kMillimetre;

BvhMotion Motion(const SyntheticRecording& made, int n) {
  BvhMotion motion;
  motion.skeleton = made.skeletons[n].Bvh(kUnit);
  motion.length_unit = kUnit;
  motion.frame_time_s = 1.0 / made.recording.fps;
  const RecordedPerson& person = made.recording.people[n];
  for (int t = 0; t < made.recording.num_frames(); ++t) {
    const PendulumState<double>& state = made.path.At(t, n);
    // Only the angles are used here, which know no origin.
    const Vector4<double> q = InLaboratory(made.scene.ground, t, Vector3<double>::Zero(), state).q;
    made.skeletons[n].AppendFrame(
        {q[2], q[3], person.hip[t], person.left_ankle[t], person.right_ankle[t]}, kUnit,
        &motion.values);
  }
  return motion;
}

std::string GroundFile(const Recording& recording) { return "ground/" + recording.id + ".csv"; }
// Names are the motion's: in a row one for each person.
std::string OfPerson(const Recording& recording, size_t n) {
  return recording.id + (recording.people.size() > 1 ? "_" + std::to_string(n) : "");
}
std::string PlatesFile(const Recording& recording, size_t n) {
  return "plates/" + OfPerson(recording, n) + ".csv";
}

// A row for each frame: its time, then the numbers.
template <typename Row>
MaybeError WriteTimed(const std::string& path, const std::string& names, double fps, int frames,
                      const Row& row) {
  std::string text = "time," + names + "\n";
  for (int t = 0; t < frames; ++t) {
    text += DoubleText(t / fps);
    for (double value : row(t)) text += "," + DoubleText(value);
    text += "\n";
  }
  return WriteFileAtomically(path, text);
}

// The ground's and the platforms' files, where the recording has them.
MaybeError WriteLaboratory(const std::string& folder, const SyntheticRecording& made) {
  const Recording& recording = made.recording;
  const int frames = recording.num_frames();
  if (made.scene.ground.moves()) {
    if (MaybeError failed = MakeFolder(folder + "/ground")) return failed;
    if (MaybeError failed = WriteTimed(folder + "/" + GroundFile(recording), "x,y,theta,phi",
                                       recording.fps, frames, [&](int t) {
                                         const GroundPose& pose = recording.ground[t];
                                         return std::vector<double>(pose.data(), pose.data() + 4);
                                       })) {
      return failed;
    }
  }
  for (size_t n = 0; n < recording.people.size(); ++n) {
    const std::vector<PlateSample>& plates = recording.people[n].plates;
    if (plates.empty()) continue;
    if (MaybeError failed = MakeFolder(folder + "/plates")) return failed;
    if (MaybeError failed = WriteTimed(folder + "/" + PlatesFile(recording, n), "fx,fy,fz,px,py",
                                       recording.fps, frames, [&plates](int t) {
                                         const PlateSample& s = plates[t];
                                         return std::vector<double>{s.force[0], s.force[1],
                                                                    s.force[2], s.centre[0],
                                                                    s.centre[1]};
                                       })) {
      return failed;
    }
  }
  return std::nullopt;
}

ManifestRecording Entry(const SyntheticRecording& made, const std::vector<std::string>& bvh,
                        const std::string& csv) {
  const Recording& recording = made.recording;
  const std::vector<BvhJoint> joints = made.skeletons[0].Bvh(kUnit).joints;
  ManifestRecording entry = EntryOf(recording);
  for (const RecordedPerson& person : recording.people) {
    entry.subjects.push_back({person.subject_id, person.mass_kg});
  }
  entry.motion = bvh;
  entry.joints.hip = JointReference{joints[kHipJoint].name};
  entry.joints.left_ankle = JointReference{joints[kLeftAnkleJoint].name};
  entry.joints.right_ankle = JointReference{joints[kRightAnkleJoint].name};
  if (made.scene.ground.moves()) (*entry.json)["ground"] = {{"csv", GroundFile(recording)}};
  for (size_t n = 0; n < recording.people.size(); ++n) {
    if (recording.people[n].plates.empty()) continue;
    nlohmann::ordered_json plates = {{"use", "measure"}, {"file", PlatesFile(recording, n)}};
    if (recording.people.size() == 1) {
      (*entry.json)["force_plates"] = plates;
      continue;
    }
    plates["person"] = n;
    (*entry.json)["force_plates"].push_back(plates);
  }
  if (recording.pushes.empty()) return entry;
  const int start = recording.pushes[0].start_frame;
  if (start == 0) {
    entry.push_csv = csv;
  } else {
    entry.pushes = {{0, csv, start}};
  }
  return entry;
}

}  // namespace

MaybeError WriteSyntheticRecordings(const std::string& folder, const SyntheticOptions& options,
                                    const std::vector<SyntheticRecording>& recordings) {
  for (const char* sub : {"bvh", "push"}) {
    if (MaybeError failed = MakeFolder(folder + "/" + sub)) return failed;
  }
  Manifest manifest;
  manifest.length_unit = kUnit;
  auto& about = (*manifest.json)["synthetic"];
  about["seed"] = options.seed;
  about["stance"] = NameOf(options.model.stance);
  about["joint_noise_m"] = options.joint_noise_m;
  for (int i = 0; i < kFirstOwnParameter; ++i) {
    if (IsNoiseParameter(static_cast<Parameter>(i))) continue;
    about["truth"][std::string(kParameterNames[i])] = options.parameters[i];
  }
  if (options.model.process_noise != ProcessNoise::kNone) {
    for (int i = kFirstNoiseParameter; i < kMeasuredCart; ++i) {
      about["truth"][std::string(kParameterNames[i])] = options.parameters[i];
    }
  }
  // The cart is the middle of two ankles.
  about["truth"]["measured_cart"] = options.joint_noise_m / std::sqrt(2.0);
  about["truth"]["measured_hip"] = options.joint_noise_m;
  for (const SyntheticRecording& made : recordings) {
    const std::string csv = "push/" + made.recording.id + ".csv";
    const int people = made.scene.num_people();
    std::vector<std::string> bvh;
    for (int n = 0; n < people; ++n) {
      bvh.push_back("bvh/" + OfPerson(made.recording, static_cast<size_t>(n)) + ".bvh");
      if (MaybeError failed = WriteBvh(folder + "/" + bvh.back(), Motion(made, n), kUnit)) {
        return failed;
      }
    }
    if (MaybeError failed = WriteLaboratory(folder, made)) return failed;
    if (!made.recording.pushes.empty()) {
      if (MaybeError failed = WritePushCsv(folder + "/" + csv, made.recording.pushes[0].force)) {
        return failed;
      }
    }
    manifest.recordings.push_back(Entry(made, bvh, csv));
  }
  return WriteManifest(folder + "/manifest.json", manifest);
}

}  // namespace pushid
