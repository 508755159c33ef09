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

}  // namespace pushid
