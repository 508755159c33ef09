// datasets: a recording from tracks in memory, and tracks from any motion file.
#include "datasets/loading/recording_from_tracks.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "datasets/files/input_file.h"
#include "datasets/files/number_text.h"
#include "datasets/formats/bvh.h"
#include "datasets/loading/ground_record.h"
#include "datasets/loading/plate_record.h"
#include "datasets/manifest/manifest.h"
#include "models/enum_names.h"
#include "models/skeleton_mapping.h"

namespace pushid {
namespace {

Error Of(const std::string& id, const std::string& what) {
  return Error{"recording " + Quoted(id) + ": " + what};
}

template <typename Rows>
void AddRows(const Rows& rows, ContentHash* hash) {
  for (const auto& row : rows) hash->Add(row.data(), row.size());
}

Result<RecordedPerson> PersonFrom(TrackedPerson tracks, int max_gap, const std::string& id,
                                  FilledTracks* filled) {
  if (!(tracks.mass_kg > 0.0 && tracks.mass_kg <= kHeaviestPerson)) {
    return Of(id, "the mass of " + Quoted(tracks.id) + " is " + Rounded(tracks.mass_kg) +
                      " kg; it must be above 0 and at most " + Rounded(kHeaviestPerson));
  }
  const size_t frames = tracks.hip.size();
  if (tracks.left_ankle.size() != frames || tracks.right_ankle.size() != frames) {
    return Of(id, "hip and ankles of " + Quoted(tracks.id) + " have " + std::to_string(frames) +
                      ", " + std::to_string(tracks.left_ankle.size()) + " and " +
                      std::to_string(tracks.right_ankle.size()) + " frames; they share them");
  }
  RecordedPerson person;
  person.subject_id = tracks.id;
  person.mass_kg = tracks.mass_kg;
  *filled = FillTracks(max_gap, {&tracks.hip, &tracks.left_ankle, &tracks.right_ankle});
  if (frames > 0 && filled->weight[0] == 0.0) {
    return Of(id, "at frame 0, where the fit starts, hip or ankles of " + Quoted(tracks.id) +
                      " are missing; leave out the frames before they are visible");
  }
  person.plates = std::move(tracks.plates);
  person.hip = std::move(tracks.hip);
  person.left_ankle = std::move(tracks.left_ankle);
  person.right_ankle = std::move(tracks.right_ankle);
  if (!filled->AllCount()) person.weight = filled->weight;
  if (MaybeError wrong = CheckMotion(person, 1.0)) {
    return Of(id, tracks.id + ": " + wrong->message);
  }
  return person;
}

MaybeError CheckPush(const TrackedRecording& tracks, const Push& push, int frames) {
  const int people = static_cast<int>(tracks.people.size());
  if (push.person < 0 || push.person >= people) {
    return Of(tracks.id, "there is no person " + std::to_string(push.person) + " to push; it has " +
                             std::to_string(people) + ", counted from 0");
  }
  const int rows = static_cast<int>(push.force.size());
  if (push.start_frame < 0 || rows == 0 || push.start_frame > frames - 2 ||
      push.start_frame + rows > frames) {
    return Of(tracks.id, "a push of " + std::to_string(rows) + " rows from frame " +
                             std::to_string(push.start_frame) + " is not within its " +
                             std::to_string(frames) + " frames");
  }
  for (const Eigen::Vector4d& row : push.force) {
    if (!row.allFinite()) return Of(tracks.id, "the push has a value that is not finite");
  }
  return std::nullopt;
}

// Ground and platforms share the motion's frames.
MaybeError TakeLaboratory(std::vector<GroundPose> ground, const PreparationOptions& preparation,
                          Recording* recording, ContentHash* hash) {
  const auto frames = static_cast<size_t>(recording->num_frames());
  const auto differ = [&](const std::string& what, size_t rows) {
    return Of(recording->id, what + " has " + std::to_string(rows) + " rows, the motion " +
                                 std::to_string(frames) + " frames; they share them");
  };
  bool any = !ground.empty();
  if (any && ground.size() != frames) return differ("ground", ground.size());
  AddRows(ground, hash);
  for (GroundPose& pose : ground) {
    if (!pose.allFinite()) return Of(recording->id, "ground has a value that is not finite");
  }
  const GroundPose first = ground.empty() ? GroundPose(GroundPose::Zero()) : ground[0];
  for (GroundPose& pose : ground) pose -= first;
  const auto some = static_cast<size_t>(std::max(5.0, 1.0 + std::round(0.1 * recording->fps)));
  const double speed = GroundSpeedAtFirst(
      {ground.begin(), ground.begin() + static_cast<std::ptrdiff_t>(std::min(some, ground.size()))},
      1.0 / recording->fps);
  if (speed > kGroundAtRest) {
    return Of(recording->id, "the ground moves by " + Rounded(speed, 2) +
                                 " per second (m or rad) at frame 0, where people are taken to be "
                                 "at rest; start the recording earlier");
  }
  recording->ground = std::move(ground);
  for (size_t n = 0; n < recording->people.size(); ++n) {
    const std::vector<PlateSample>& plates = recording->people[n].plates;
    if (plates.empty()) continue;
    any = true;
    const std::string whose = "plates of " + Quoted(recording->people[n].subject_id);
    if (plates.size() != frames) return differ(whose, plates.size());
    for (const PlateSample& sample : plates) {
      if (!sample.force.allFinite() || !sample.centre.allFinite()) {
        return Of(recording->id, whose + " have a value that is not finite");
      }
      hash->Add(sample.force.data(), 3);
      hash->Add(sample.centre.data(), 3);
    }
    if (MaybeError wrong = CheckPlates("", *recording, static_cast<int>(n))) {
      return Of(recording->id, wrong->message);
    }
  }
  if (any && preparation.resample_fps > 0.0) {
    return Of(recording->id,
              "ground and plates are taken at the motion's frames; leave resampling out");
  }
  return std::nullopt;
}

// Turns indices into the file's joints to indices into the list of those that are read.
std::vector<int> Among(const std::vector<int>& wanted, std::vector<int>* read) {
  std::vector<int> places;
  for (int joint : wanted) {
    const auto found = std::find(read->begin(), read->end(), joint);
    places.push_back(static_cast<int>(found - read->begin()));
    if (found == read->end()) read->push_back(joint);
  }
  return places;
}

// Which of the file's `all` joints are read; where the pendulum's stand among those.
std::vector<int> Wanted(const FileMotionRequest& request, const PendulumJoints& joints,
                        std::size_t all, FileMotion* motion) {
  std::vector<int> read(request.keep_all_joints ? all : 0);
  std::iota(read.begin(), read.end(), 0);
  for (const PendulumTrack& row : kPendulumTracks) {
    motion->places.*row.joints = Among(joints.*row.joints, &read);
  }
  return read;
}

// Sets roles of the file's joints, which are all kept where there are roles.
MaybeError SetRoles(const FileMotionRequest& request, const std::vector<std::string>& names,
                    const BvhSkeleton* skeleton, const PendulumJoints& joints, FileMotion* motion) {
  if (!request.keep_all_joints) return std::nullopt;
  Result<BodyRoles> roles = ChooseRoles(request.path, names, skeleton, joints, request.joints);
  if (!roles.ok()) return roles.error();
  motion->roles = std::move(roles.value());
  return std::nullopt;
}

Result<FileMotion> ReadSkeleton(const FileMotionRequest& request) {
  FileMotion motion;
  motion.metres_per_unit = request.metres_per_unit.value_or(motion.metres_per_unit);
  BvhPositionOptions options;
  options.metres_per_unit = motion.metres_per_unit;
  if (request.keep_all_joints) options.kept_frame = request.first_frame;
  options.choose_joints = [&](const BvhSkeleton& skeleton) -> Result<std::vector<int>> {
    const Result<PendulumJoints> joints =
        ChoosePendulumJoints(request.path, skeleton, request.joints);
    if (!joints.ok()) return joints.error();
    if (MaybeError failed =
            SetRoles(request, skeleton.Names(), &skeleton, joints.value(), &motion)) {
      return *std::move(failed);
    }
    return Wanted(request, joints.value(), skeleton.joints.size(), &motion);
  };
  Result<BvhPositions> bvh = ReadBvhPositions(request.path, options);
  if (!bvh.ok()) return bvh.error();
  motion.tracks = std::move(bvh.value().positions);
  motion.frame_time_s = bvh.value().frame_time_s;
  motion.content_hash = bvh.value().content_hash;
  for (int joint : bvh.value().joints) {
    motion.names.push_back(bvh.value().skeleton.joints[joint].name);
    motion.parents.push_back(bvh.value().skeleton.joints[joint].parent);
  }
  if (request.keep_all_joints) {
    motion.skeleton = FileSkeleton{std::move(bvh.value().skeleton),
                                   std::move(bvh.value().kept_values), motion.metres_per_unit};
  }
  return motion;
}

// An Error where a file gives a unit that is not known and nothing else says one.
MaybeError SetUnit(const FileMotionRequest& request, const PointMotion& points,
                   FileMotion* motion) {
  const double files = points.unit ? MetresPer(*points.unit) : motion->metres_per_unit;
  motion->metres_per_unit = request.metres_per_unit.value_or(files);
  if (!points.unit && !Trimmed(points.unit_text).empty() && !request.metres_per_unit) {
    return Error{"gives lengths in " + Quoted(points.unit_text) +
                     ", an unknown unit; give length_unit (" + AnyName<LengthUnit>() +
                     ") or length_scale (m) in the manifest",
                 request.path};
  }
  if (points.unit && files != motion->metres_per_unit) {
    request.warn("gives lengths in " + NameOf(*points.unit) + "; they are read as " +
                 LengthText(motion->metres_per_unit));
  }
  return std::nullopt;
}

// A base of support at the origin of its log: elsewhere 0, 0, 0 is a point that was not seen.
void PutBaseAtOrigin(const JointMapping& joints, FileMotion* motion) {
  if (joints.others.count(kBaseRole) == 0) return;
  for (int base : motion->places.left_ankle) {
    auto& track = motion->tracks[base];
    const bool seen = std::any_of(track.begin(), track.end(),
                                  [](const Eigen::Vector3d& p) { return p.allFinite(); });
    if (!seen) track.assign(track.size(), Eigen::Vector3d::Zero());
  }
}

Result<FileMotion> ReadPoints(const FileMotionRequest& request) {
  FileMotion motion;
  PointReadOptions options;
  options.columns = request.mapping.columns;
  options.time_column = request.mapping.time_column;
  options.choose = [&](const std::vector<std::string>& names) -> Result<std::vector<int>> {
    const Result<PendulumJoints> joints = ChoosePendulumPoints(request.path, names, request.joints);
    if (!joints.ok()) return joints.error();
    if (MaybeError failed = SetRoles(request, names, nullptr, joints.value(), &motion)) {
      return *std::move(failed);
    }
    return Wanted(request, joints.value(), names.size(), &motion);
  };
  Result<PointMotion> read = ReadPointMotion(request.path, request.format, options);
  if (!read.ok()) return read.error();
  PointMotion& points = read.value();
  if (MaybeError failed = SetUnit(request, points, &motion)) return *std::move(failed);
  motion.tracks = std::move(points.positions);
  for (auto& track : motion.tracks) {
    for (Eigen::Vector3d& position : track) position *= motion.metres_per_unit;
  }
  PutBaseAtOrigin(request.joints, &motion);
  const double rate =
      request.mapping.frame_rate > 0.0 ? request.mapping.frame_rate : points.rate_hz;
  motion.frame_time_s = rate > 0.0 ? 1.0 / rate : 0.0;
  motion.first_time_s = points.first_time_s;
  motion.content_hash = points.content_hash;
  for (int point : points.chosen) motion.names.push_back(points.names[point]);
  motion.parents.assign(motion.names.size(), -1);
  return motion;
}

}  // namespace

Result<Recording> RecordingFromTracks(TrackedRecording tracks,
                                      const PreparationOptions& preparation, Warnings* warnings) {
  const std::string rate = FrameRateProblem(tracks.fps);
  if (!rate.empty()) return Of(tracks.id, "fps " + rate);
  if (tracks.people.empty()) return Of(tracks.id, "it contains no people");
  Recording recording;
  recording.id = tracks.id;
  recording.fps = tracks.fps;
  recording.labels = std::move(tracks.labels);
  if (recording.labels.setting().empty()) recording.labels.Set(kSettingLabel, "single");
  recording.pushed_person = tracks.pushed_person;
  recording.push_kind = tracks.push_kind;
  recording.initial_velocity = tracks.initial_velocity;
  ContentHash hash;
  const int max_gap = static_cast<int>(std::floor(preparation.max_gap_s * tracks.fps + 1e-9));
  for (TrackedPerson& one : tracks.people) {
    for (const auto* track : {&one.hip, &one.left_ankle, &one.right_ankle}) AddRows(*track, &hash);
    const std::string who = one.id;
    FilledTracks filled;
    Result<RecordedPerson> person = PersonFrom(std::move(one), max_gap, tracks.id, &filled);
    if (!person.ok()) return person.error();
    const std::string gaps = filled.Warning(preparation.max_gap_s);
    if (!gaps.empty() && warnings != nullptr) {
      warnings->emplace_back("recording " + Quoted(tracks.id) + ": " + who + " " + gaps, tracks.id,
                             "a person " + gaps);
    }
    recording.people.push_back(std::move(person.value()));
    if (recording.people.back().hip.size() != recording.people[0].hip.size()) {
      return Of(tracks.id, "its people have different numbers of frames");
    }
  }
  for (const Push& push : tracks.pushes) {
    if (MaybeError wrong = CheckPush(tracks, push, recording.num_frames())) return *wrong;
    AddRows(push.force, &hash);
  }
  if (MaybeError wrong = TakeLaboratory(std::move(tracks.ground), preparation, &recording, &hash)) {
    return *std::move(wrong);
  }
  recording.pushes = std::move(tracks.pushes);
  recording.content_hash = hash.Hex();
  if (MaybeError failed = CheckPreparation(preparation)) return *failed;
  if (MaybeError failed = PrepareMotion(preparation, &recording)) {
    return Of(recording.id, failed->message);
  }
  return recording;
}

double HeightFraction(const Body& body, const Vector4<double>& q, double height) {
  return (height - body.cart_height) / (body.rod_length * std::cos(q[2]) * std::cos(q[3]));
}

std::vector<Eigen::Vector4d> PushAtHeight(const RecordedPerson& person, int start,
                                          const std::vector<Eigen::Vector3d>& forces,
                                          const PushHeight& height) {
  const auto pose = [&person](size_t frame) {
    const size_t t = std::min(frame, person.hip.size() - 1);
    return MapSkeleton(person.hip[t], person.left_ankle[t], person.right_ankle[t]);
  };
  const MappedPose first = pose(0);
  const Body body{person.mass_kg, first.rod_length, first.cart_height};
  const double fraction =
      height.metres ? HeightFraction(body, pose(start).q, *height.metres) : height.fraction;
  std::vector<Eigen::Vector4d> rows;
  for (size_t t = 0; t < forces.size(); ++t) {
    rows.push_back(GeneralizedForce<double>(body, pose(start + t).q, forces[t], fraction));
  }
  return rows;
}

Result<FileMotion> ReadFileMotion(const FileMotionRequest& request) {
  return HasSkeleton(request.format) ? ReadSkeleton(request) : ReadPoints(request);
}

}  // namespace pushid
