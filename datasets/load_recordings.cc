// datasets: from a manifest to recordings in SI units, checked.
#include "datasets/load_recordings.h"

#include <cmath>
#include <utility>

#include "datasets/axes.h"
#include "datasets/bvh.h"
#include "datasets/joint_choice.h"
#include "datasets/motion_checks.h"
#include "datasets/number_text.h"
#include "datasets/push_csv.h"
#include "datasets/select_recordings.h"

namespace pushid {
namespace {

// fps and a BVH's rounded frame time agree within this: 0.016667 s against 60 Hz is 0.002 %.
constexpr double kFrameTimeTolerance = 1e-3;

// Puts the recording's name in front of what went wrong with one of its files.
Error OfRecording(const ManifestRecording& entry, Error error) {
  error.message = "recording " + Quoted(entry.id) + ": " + error.message;
  return error;
}

std::string FrameTimeWarning(const ManifestRecording& entry, const std::string& file,
                             double frame_time_s) {
  if (std::abs(frame_time_s * entry.fps - 1.0) <= kFrameTimeTolerance) return "";
  return "recording " + Quoted(entry.id) + ": " + file + " has a frame time of " +
         Rounded(frame_time_s) + " s (" + Rounded(1.0 / frame_time_s) +
         " frames per second), the manifest says " + Rounded(entry.fps) +
         " frames per second; the manifest's value is used";
}

// Moves tracks ([chosen joint][frame], file's axes) into the person, in the project's axes: first
// hip and ankles, then all joints where those were read.
void TakeTracks(BvhPositions bvh, const Eigen::Matrix3d& rotation, RecordedPerson* person) {
  for (auto& track : bvh.positions) {
    for (Eigen::Vector3d& position : track) position = rotation * position;
  }
  person->hip = std::move(bvh.positions[0]);
  person->left_ankle = std::move(bvh.positions[1]);
  person->right_ankle = std::move(bvh.positions[2]);
  const std::size_t joints = bvh.positions.size() - 3;
  if (joints == 0) return;
  person->joints.assign(person->hip.size(), std::vector<Eigen::Vector3d>(joints));
  for (std::size_t joint = 0; joint < joints; ++joint) {
    person->joint_names.push_back(bvh.skeleton.joints[joint].name);
    person->joint_parents.push_back(bvh.skeleton.joints[joint].parent);
    for (std::size_t frame = 0; frame < person->hip.size(); ++frame) {
      person->joints[frame][joint] = bvh.positions[3 + joint][frame];
    }
  }
}

Result<RecordedPerson> LoadPerson(const Manifest& manifest, const ManifestRecording& entry,
                                  std::size_t index, const LoadOptions& options,
                                  const Eigen::Matrix3d& rotation, ContentHash* hash,
                                  std::vector<std::string>* warnings) {
  RecordedPerson person;
  person.subject_id = entry.subjects[index].id;
  person.mass_kg = entry.subjects[index].mass_kg;
  person.file = ResolvePath(manifest.path, entry.bvh[index]);

  const LengthUnit unit = options.length_unit ? *options.length_unit
                          : entry.length_unit
                              ? *entry.length_unit
                              : manifest.length_unit.value_or(LengthUnit::kMillimetre);
  BvhPositionOptions bvh_options;
  bvh_options.length_unit = unit;
  bvh_options.choose_joints = [&](const BvhSkeleton& skeleton) -> Result<std::vector<int>> {
    const Result<PendulumJoints> joints = ChoosePendulumJoints(person.file, skeleton, entry.joints);
    if (!joints.ok()) return joints.error();
    std::vector<int> wanted = {joints.value().hip, joints.value().left_ankle,
                               joints.value().right_ankle};
    for (std::size_t i = 0; options.keep_all_joints && i < skeleton.joints.size(); ++i) {
      wanted.push_back(static_cast<int>(i));
    }
    return wanted;
  };
  Result<BvhPositions> bvh = ReadBvhPositions(person.file, bvh_options);
  if (!bvh.ok()) return bvh.error();
  if (entry.frames && *entry.frames != bvh.value().num_frames()) {
    return Error{"wrong frame count: the file has " + std::to_string(bvh.value().num_frames()) +
                     " frames, the manifest says " + std::to_string(*entry.frames),
                 person.file, 0};
  }
  const std::string warning = FrameTimeWarning(entry, person.file, bvh.value().frame_time_s);
  if (!warning.empty() && warnings != nullptr) warnings->push_back(warning);
  hash->Add(bvh.value().content_hash);
  TakeTracks(std::move(bvh.value()), rotation, &person);
  if (MaybeError failed = CheckMotion(person, unit)) return *std::move(failed);
  return person;
}

Result<Push> LoadPush(const Manifest& manifest, const ManifestPush& entry, int num_frames,
                      ContentHash* hash) {
  Push push;
  push.person = entry.person;
  push.start_frame = entry.start_frame;
  push.file = ResolvePath(manifest.path, entry.csv);
  Result<std::vector<Eigen::Vector4d>> force = ReadPushCsv(push.file);
  if (!force.ok()) return force.error();
  push.force = std::move(force.value());

  const std::string motion = "the motion has " + std::to_string(num_frames) + " frames";
  if (push.start_frame > num_frames - 2) {
    return Error{"the push starts at frame " + std::to_string(push.start_frame) + ", but " + motion,
                 push.file, 0};
  }
  // One row per frame is fine: a sensor records as long as the cameras, its last row drives no
  // step.
  if (push.force.size() > static_cast<std::size_t>(num_frames - push.start_frame)) {
    return Error{
        "the push is longer than the motion: it has " + std::to_string(push.force.size()) +
            " rows" +
            (push.start_frame > 0 ? " from frame " + std::to_string(push.start_frame) : "") + ", " +
            motion,
        push.file, 0};
  }
  const Result<std::string> file_hash = HashFile(push.file);
  if (!file_hash.ok()) return file_hash.error();
  hash->Add(file_hash.value());
  return push;
}

}  // namespace

Result<Recording> LoadRecording(const Manifest& manifest, const ManifestRecording& entry,
                                const LoadOptions& options, std::vector<std::string>* warnings) {
  Recording recording;
  recording.id = entry.id;
  recording.setting = entry.setting;
  recording.magnitude = entry.magnitude;
  recording.condition_code = entry.condition_code;
  recording.fps = entry.fps;
  recording.pushed_person = entry.pushed_person;
  recording.push_kind = entry.push_kind;
  recording.initial_velocity = entry.initial_velocity;

  const Result<Eigen::Matrix3d> rotation = AxesRotation(entry.up, entry.forward);
  if (!rotation.ok()) return OfRecording(entry, rotation.error());
  ContentHash hash;  // of the files' hashes, so that contents cannot slide from one into the next
  for (std::size_t i = 0; i < entry.bvh.size(); ++i) {
    Result<RecordedPerson> person =
        LoadPerson(manifest, entry, i, options, rotation.value(), &hash, warnings);
    if (!person.ok()) return OfRecording(entry, person.error());
    if (i > 0 && person.value().hip.size() != recording.people[0].hip.size()) {
      return OfRecording(entry, {"the file has " + std::to_string(person.value().hip.size()) +
                                     " frames, but " + recording.people[0].file + " has " +
                                     std::to_string(recording.people[0].hip.size()) +
                                     "; the people of one recording share their frames",
                                 person.value().file, 0});
    }
    recording.people.push_back(std::move(person.value()));
  }

  std::vector<ManifestPush> pushes = entry.pushes;
  if (!entry.push_csv.empty()) {
    pushes.insert(pushes.begin(), ManifestPush{entry.pushed_person, entry.push_csv, 0});
  }
  for (const ManifestPush& push : pushes) {
    Result<Push> loaded = LoadPush(manifest, push, recording.num_frames(), &hash);
    if (!loaded.ok()) return OfRecording(entry, loaded.error());
    recording.pushes.push_back(std::move(loaded.value()));
  }
  recording.content_hash = hash.Hex();
  return recording;
}

Result<std::vector<Recording>> LoadRecordings(const std::string& manifest_path,
                                              const LoadOptions& options,
                                              std::vector<std::string>* warnings) {
  const Result<Manifest> manifest = ReadManifest(manifest_path);
  if (!manifest.ok()) return manifest.error();
  const Result<std::vector<int>> selected =
      SelectRecordings(manifest.value(), options.setting, options.ids);
  if (!selected.ok()) return selected.error();
  std::vector<Recording> recordings;
  for (int index : selected.value()) {
    Result<Recording> recording =
        LoadRecording(manifest.value(), manifest.value().recordings[index], options, warnings);
    if (!recording.ok()) return recording.error();
    recordings.push_back(std::move(recording.value()));
  }
  return recordings;
}

}  // namespace pushid
