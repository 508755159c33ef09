// datasets: one person of a recording from the file that holds their motion.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "datasets/files/number_text.h"
#include "datasets/formats/units.h"
#include "datasets/loading/load_recordings.h"
#include "datasets/loading/motion_preparation.h"
#include "datasets/loading/recording_from_tracks.h"
#include "datasets/manifest/column_mapping.h"
#include "datasets/manifest/joint_choice.h"

namespace pushid {
namespace {

using Track = std::vector<Eigen::Vector3d>;

// fps and a BVH's rounded frame time agree within this: 0.016667 s against 60 Hz is 0.002 %.
constexpr double kFrameTimeTolerance = 1e-3;

class PersonLoader {
 public:
  PersonLoader(const Manifest& manifest, const ManifestRecording& entry, std::size_t index,
               const LoadOptions& options, Warnings* warnings)
      : manifest_(manifest), entry_(entry), index_(index), options_(options), warnings_(warnings) {
    path_ = ResolvePath(entry.manifest, entry.motion[index]);
  }

  Result<LoadedPerson> Load() {
    if (!entry_.mapping.empty()) {
      Result<ColumnMapping> mapping =
          ReadColumnMapping(ResolvePath(entry_.manifest, entry_.mapping));
      if (!mapping.ok()) return mapping.error();
      mapping_ = std::move(mapping.value());
      const Result<std::string> hash = HashFile(ResolvePath(entry_.manifest, entry_.mapping));
      if (!hash.ok()) return hash.error();
      mapping_hash_ = hash.value();
    }
    const JointMapping joints =
        Overlaid(entry_.subjects[index_].joints, Overlaid(entry_.joints, mapping_.joints));
    if (HoldsCrowd(entry_.motion_format) && !joints.hip) {
      return Error{kCrowdIsNoRecording, path_};
    }
    Result<FileMotion> read = ReadFileMotion(
        {path_, entry_.motion_format, MetresGiven(), joints, mapping_, options_.keep_all_joints,
         entry_.first_frame, [this](const std::string& warning) { Warn(warning); }});
    if (!read.ok()) return read.error();
    FileMotion& motion = read.value();
    if (MaybeError failed = SetRate(motion.frame_time_s)) return *std::move(failed);
    LoadedPerson loaded;
    loaded.fps = fps_;
    loaded.metres_per_unit = motion.metres_per_unit;
    loaded.file_hash = mapping_hash_ + motion.content_hash;
    RecordedPerson& person = loaded.person;
    person.subject_id = entry_.subjects[index_].id;
    person.mass_kg = entry_.subjects[index_].mass_kg;
    person.known = entry_.subjects[index_].known;
    person.file = path_;
    person.skipped_s =
        entry_.first_frame * (motion.frame_time_s > 0.0 ? motion.frame_time_s : 1.0 / fps_);
    person.file_clock_s = motion.first_time_s + person.skipped_s;
    if (MaybeError failed = Cut(&motion)) return *std::move(failed);
    if (MaybeError failed = CloseGaps(&motion, &person)) return *std::move(failed);
    if (MaybeError failed = Turn(&motion, &person)) return *std::move(failed);
    Take(motion, &person);
    if (MaybeError failed = CheckMotion(person, motion.metres_per_unit)) return *std::move(failed);
    return loaded;
  }

 private:
  // By a reader that does not have to believe the file; the first one counts.
  std::optional<double> MetresGiven() const {
    const std::pair<std::optional<LengthUnit>, std::optional<double>> said[] = {
        {options_.length_unit, options_.length_scale},
        {entry_.length_unit, entry_.length_scale},
        {manifest_.length_unit, manifest_.length_scale},
        {mapping_.length_unit, mapping_.length_scale}};
    for (const auto& [unit, scale] : said) {
      if (scale) return scale;
      if (unit) return MetresPer(*unit);
    }
    return std::nullopt;
  }

  void Warn(const std::string& warning) const {
    if (warnings_ == nullptr) return;
    // As the manifest names it: results keep warnings, and not where the data lay.
    const std::string& file = entry_.motion[index_];
    warnings_->emplace_back("recording " + Quoted(entry_.id) + ": " + file + " " + warning,
                            entry_.id, "the file " + warning);
  }

  // The manifest's rate; where it gives none, that of the file.
  MaybeError SetRate(double frame_time_s) {
    fps_ = entry_.fps;
    if (fps_ > 0.0) {
      WarnOfRate(frame_time_s);
      return std::nullopt;
    }
    if (frame_time_s == 0.0) {
      return Error{
          "neither the file nor the manifest gives the frame rate; give fps in the manifest",
          path_};
    }
    fps_ = WholeFrameRate(1.0 / frame_time_s);
    const std::string problem = FrameRateProblem(fps_);
    if (problem.empty()) return std::nullopt;
    return Error{"the file's frame rate " + problem + "; give the right one as fps in the manifest",
                 path_};
  }

  void WarnOfRate(double frame_time_s) const {
    if (frame_time_s == 0.0 || std::abs(frame_time_s * fps_ - 1.0) <= kFrameTimeTolerance) {
      return;
    }
    Warn("has a frame time of " + Rounded(frame_time_s) + " s (" + Rounded(1.0 / frame_time_s) +
         " frames per second), the manifest gives " + Rounded(fps_) +
         " frames per second; the manifest's value is used");
  }

  MaybeError Cut(FileMotion* motion) const {
    const int frames = static_cast<int>(motion->tracks[0].size());
    if (entry_.frames && *entry_.frames != frames) {
      return Error{"wrong frame count: the file has " + std::to_string(frames) +
                       " frames, the manifest gives " + std::to_string(*entry_.frames),
                   path_};
    }
    const int end = entry_.end_frame.value_or(frames);
    if (entry_.first_frame == 0 && end == frames) return std::nullopt;
    if (end > frames || entry_.first_frame >= end) {
      return Error{"the file has " + std::to_string(frames) + " frames, too few for first_frame " +
                       std::to_string(entry_.first_frame) + " and end_frame " + std::to_string(end),
                   path_};
    }
    for (Track& track : motion->tracks) {
      track = Track(track.begin() + entry_.first_frame, track.begin() + end);
    }
    return std::nullopt;
  }

  // Only gaps of hip and ankles take weight from a frame.
  MaybeError CloseGaps(FileMotion* motion, RecordedPerson* person) const {
    const std::size_t frames = motion->tracks[0].size();
    const int max_gap = static_cast<int>(std::floor(options_.preparation.max_gap_s * fps_ + 1e-9));
    std::vector<double> unused(frames, 1.0);
    std::vector<Track*> counting;
    for (std::size_t i = 0; i < motion->tracks.size(); ++i) {
      Track& track = motion->tracks[i];
      if (IsPlace(motion->places, static_cast<int>(i))) {
        counting.push_back(&track);
        if (std::none_of(track.begin(), track.end(), [](const auto& p) { return p.allFinite(); })) {
          return Error{motion->names[i] + " is never seen; choose another by \"joints\"", path_};
        }
        continue;
      }
      const GapCount count = FillGaps(max_gap, &track, &unused);
      if (count.excluded_frames > 0) Forget(static_cast<int>(i), &motion->places);
      if (count.excluded_frames == static_cast<int>(frames)) {
        ForgetRoles(static_cast<int>(i), &motion->roles);
      }
    }
    FilledTracks filled = FillTracks(max_gap, counting);
    std::vector<double>& weight = filled.weight;
    if (filled.gaps == 0) return std::nullopt;
    if (weight[0] == 0.0) {
      const auto seen = std::find(weight.begin(), weight.end(), 1.0);
      return Error{"at frame " + std::to_string(entry_.first_frame) +
                       ", where the fit starts, hip or ankles are missing; " +
                       (seen == weight.end()
                            ? std::string("no frame shows them all")
                            : "set first_frame to " +
                                  std::to_string(entry_.first_frame + (seen - weight.begin())) +
                                  " or later in the manifest"),
                   path_};
    }
    Warn(filled.Warning(options_.preparation.max_gap_s));
    if (!filled.AllCount()) person->weight = std::move(weight);
    return std::nullopt;
  }

  // A toe or heel that is lost for long says nothing of where the foot stands.
  static void Forget(int track, PendulumJoints* places) {
    for (const PendulumTrack& row : kPendulumTracks) {
      if (!row.required && Holds(places->*row.joints, track)) (places->*row.joints).clear();
    }
  }

  // A marker that is never seen plays no role.
  static void ForgetRoles(int track, BodyRoles* roles) {
    for (std::vector<int>& joints : roles->joints) {
      if (Holds(joints, track)) joints.clear();
    }
    for (std::vector<int>* joints : {&roles->left_asis, &roles->right_asis, &roles->back}) {
      if (Holds(*joints, track)) joints->clear();
    }
  }

  static bool IsPlace(const PendulumJoints& places, int track) {
    for (const PendulumTrack& row : kPendulumTracks) {
      if (row.required && Holds(places.*row.joints, track)) return true;
    }
    return false;
  }
  static bool Holds(const std::vector<int>& joints, int track) {
    return std::find(joints.begin(), joints.end(), track) != joints.end();
  }

  MaybeError Turn(FileMotion* motion, RecordedPerson* person) const {
    const bool own =
        mapping_.up.empty() || entry_.json->contains("up") || entry_.json->contains("forward");
    person->file_up = own ? entry_.up : mapping_.up;
    person->file_forward = own ? entry_.forward : mapping_.forward;
    const Result<Eigen::Matrix3d> rotation = AxesRotation(person->file_up, person->file_forward);
    if (!rotation.ok()) return rotation.error();
    for (Track& track : motion->tracks) {
      for (Eigen::Vector3d& position : track) position = rotation.value() * position;
    }
    return std::nullopt;
  }

  static Track Mean(const std::vector<Track>& tracks, const std::vector<int>& chosen) {
    if (chosen.empty()) return {};
    Track mean = tracks[chosen[0]];
    for (std::size_t frame = 0; frame < mean.size(); ++frame) {
      for (std::size_t i = 1; i < chosen.size(); ++i) mean[frame] += tracks[chosen[i]][frame];
      mean[frame] /= static_cast<double>(chosen.size());
    }
    return mean;
  }

  void Take(FileMotion& motion, RecordedPerson* person) const {
    for (const PendulumTrack& row : kPendulumTracks) {
      person->*row.track = Mean(motion.tracks, motion.places.*row.joints);
    }
    if (!options_.keep_all_joints) return;
    person->joint_names = motion.names;
    person->joint_parents = motion.parents;
    person->roles = motion.roles;
    person->skeleton = std::move(motion.skeleton);
    if (person->skeleton) {
      person->skeleton->world_from_file =
          AxesRotation(person->file_up, person->file_forward).value();
    }
    const std::vector<int> filled = FilledRoles(motion.roles);
    if (!filled.empty() && UnfilledRoles(motion.roles).empty()) {
      Warn(
          "has no joints for " + RoleList(filled) +
          ", which are filled from their neighbours; name them by \"joints\" if the file has them");
    }
    person->joints.assign(person->hip.size(), Track(motion.tracks.size()));
    for (std::size_t joint = 0; joint < motion.tracks.size(); ++joint) {
      for (std::size_t frame = 0; frame < person->hip.size(); ++frame) {
        person->joints[frame][joint] = motion.tracks[joint][frame];
      }
    }
  }

  const Manifest& manifest_;
  const ManifestRecording& entry_;
  const std::size_t index_;
  const LoadOptions& options_;
  Warnings* const warnings_;
  std::string path_;
  ColumnMapping mapping_;
  std::string mapping_hash_;
  double fps_ = 0.0;
};

}  // namespace

Result<LoadedPerson> LoadPerson(const Manifest& manifest, const ManifestRecording& entry,
                                std::size_t index, const LoadOptions& options, Warnings* warnings) {
  return PersonLoader(manifest, entry, index, options, warnings).Load();
}

}  // namespace pushid
