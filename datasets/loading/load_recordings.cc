// datasets: from a manifest to recordings in SI units, checked.
#include "datasets/loading/load_recordings.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>
#include <utility>

#include "datasets/files/number_text.h"
#include "datasets/formats/bvh.h"
#include "datasets/formats/force_csv.h"
#include "datasets/formats/motion_formats.h"
#include "datasets/loading/laboratory_record.h"
#include "datasets/loading/motion_tracks.h"
#include "datasets/manifest/joint_mapping.h"

namespace pushid {
namespace {

void CheckWithin(const Push& push, int num_frames) {
  const std::string motion = StrCat("the motion has ", num_frames, " frames");
  if (push.start_frame > num_frames - 2) {
    throw Error{StrCat("the push starts at frame ", push.start_frame, ", but ", motion), push.file};
  }
  // One row per frame is fine: a sensor records as long as the cameras, its last row drives no
  // step.
  if (push.EndFrame() <= num_frames) return;
  throw Error{
      StrCat("the push is longer than the motion: it has ", push.force.size(), " rows",
             push.start_frame > 0 ? StrCat(" from frame ", push.start_frame) : "", ", ", motion),
      push.file};
}

// Rows as generalized forces: files without torques have the height that the manifest gives.
std::vector<Eigen::Vector4d> GeneralizedRows(const ManifestRecording& recorded, const Push& push,
                                             PushRows rows, const Recording& recording,
                                             Warnings* warnings) {
  if (!rows.has_torques) {
    std::vector<Eigen::Vector3d> forces;
    for (const Eigen::Vector4d& row : rows.force) forces.emplace_back(row[0], row[1], 0.0);
    return PushAtHeight(recording.people[push.person], push.start_frame, forces,
                        {1.0, recorded.push_height_m});
  }
  if (recorded.push_height_m) {
    throw Error{
        "the manifest gives push_height_m, and the push has the torques ftheta and fphi, "
        "which say its height as well; leave one of them out",
        push.file};
  }
  const auto at_ankles = [](const Eigen::Vector4d& row) { return row.tail<2>().isZero(0.0); };
  const auto idle = [](const Eigen::Vector4d& row) { return row.isZero(0.0); };
  if (recorded.push_kind == PushKind::kExternal &&
      std::all_of(rows.force.begin(), rows.force.end(), at_ankles) &&
      !std::all_of(rows.force.begin(), rows.force.end(), idle)) {
    WarnOf(recorded.id,
           "the push has ftheta and fphi of 0 throughout, which is a push at the ankles; leave "
           "these columns out for one at the hip, or at push_height_m",
           warnings);
  }
  return std::move(rows.force);
}

void LoadPush(const ManifestRecording& recorded, const ManifestPush& entry, ContentHash* hash,
              Recording* recording, Warnings* warnings) {
  Push push;
  push.person = entry.person;
  push.file = ResolvePath(recorded.manifest, entry.csv);
  push.start_frame = entry.start_frame;
  push.force =
      GeneralizedRows(recorded, push, OrThrow(ReadPushCsv(push.file)), *recording, warnings);
  CheckWithin(push, recording->num_frames());
  hash->Add(OrThrow(HashFile(push.file)));
  recording->pushes.push_back(std::move(push));
}

using Track = std::vector<Eigen::Vector3d>;

// One person of a recording from the file that holds their motion.
struct LoadedPerson {
  RecordedPerson person;
  double fps = 0.0;       // the manifest's, otherwise the file's
  std::string file_hash;  // of the file (and of the mapping, where there is one)
};

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

bool NeverSeen(const Track& track) {
  return std::none_of(track.begin(), track.end(), [](const auto& p) { return p.allFinite(); });
}

// fps and a BVH's rounded frame time agree within this: 0.016667 s against 60 Hz is 0.002 %.
constexpr double kFrameTimeTolerance = 1e-3;

// Reads the file of subject `index`, cuts it to the manifest's frames, closes gaps, turns it to the
// project's units and axes and checks that it can be a person.
class PersonLoader {
 public:
  PersonLoader(const Manifest& manifest, const ManifestRecording& entry, std::size_t index,
               const LoadOptions& options, Warnings* warnings)
      : manifest_(manifest), entry_(entry), index_(index), options_(options), warnings_(warnings) {
    path_ = ResolvePath(entry.manifest, entry.motion[index]);
  }

  // Throws an Error.
  LoadedPerson Load() {
    if (!entry_.mapping.empty()) {
      const std::string file = ResolvePath(entry_.manifest, entry_.mapping);
      mapping_ = OrThrow(ReadColumnMapping(file));
      mapping_hash_ = OrThrow(HashFile(file));
    }
    joints_ = Overlaid(entry_.subjects[index_].joints, Overlaid(entry_.joints, mapping_.joints));
    const bool crowd = HoldsCrowd(entry_.motion_format) ||
                       (entry_.motion_format == MotionFormat::kCsv && IsCrowdCsv(path_));
    if (crowd && !joints_.Of(kBodyHip)) throw Error{kCrowdIsNoRecording, path_};
    Read();
    SetRate();
    LoadedPerson loaded;
    loaded.fps = fps_;
    loaded.file_hash = mapping_hash_ + file_.content_hash;
    RecordedPerson& person = loaded.person;
    person.subject_id = entry_.subjects[index_].id;
    person.mass_kg = entry_.subjects[index_].mass_kg;
    person.known = entry_.subjects[index_].known;
    person.file = path_;
    person.skipped_s = entry_.first_frame / (file_.rate_hz > 0.0 ? file_.rate_hz : fps_);
    person.file_clock_s = file_.first_time_s + person.skipped_s;
    Cut();
    CloseGaps(&person);
    Turn(&person);
    Take(&person);
    OrThrow(CheckMotion(person, metres_per_unit_));
    return loaded;
  }

 private:
  // Chooses the points that are read of the file's, and sets their roles where all are kept.
  std::vector<int> Choose(const PointMotion& file) {
    const PendulumJoints joints =
        OrThrow(ChoosePendulum(path_, file.names, file.skeleton.get(), joints_));
    std::vector<int> read;
    if (options_.keep_all_joints) {
      roles_ = OrThrow(ChooseRoles(path_, file.names, file.skeleton.get(), joints, joints_));
      read.resize(file.names.size());
      std::iota(read.begin(), read.end(), 0);
    }
    for (const PendulumTrack& row : kPendulumTracks) {
      places_.*row.joints = Among(joints.*row.joints, &read);
    }
    return read;
  }

  void Read() {
    PointReadOptions options;
    options.columns = mapping_.columns;
    options.time_column = mapping_.time_column;
    options.first_kept = entry_.first_frame;
    options.kept_rows = options_.keep_all_joints ? 1 : 0;
    options.choose = [this](const PointMotion& file) { return Choose(file); };
    file_ = OrThrow(ReadPointMotion(path_, entry_.motion_format, options));
    if (mapping_.frame_rate > 0.0 && file_.skeleton == nullptr) file_.rate_hz = mapping_.frame_rate;
    SetUnit();
    for (Track& track : file_.positions) {
      for (Eigen::Vector3d& position : track) position *= metres_per_unit_;
    }
    // A base of support at the origin of its log: elsewhere 0, 0, 0 is a point that was not seen.
    for (int base : places_.left_ankle) {
      Track& track = file_.positions[base];
      const bool is_base = joints_.of_role.count(kBaseRole) > 0;
      if (is_base && NeverSeen(track)) track.assign(track.size(), Eigen::Vector3d::Zero());
    }
  }

  // Throws where a file gives a unit that is not known and nothing else says one.
  void SetUnit() {
    const std::optional<double> given = MetresGiven();
    const double files = MetresPer(file_.unit.value_or(LengthUnit::kMillimetre));
    metres_per_unit_ = given.value_or(files);
    if (!file_.unit && !Trimmed(file_.unit_text).empty() && !given) {
      throw Error{"gives lengths in " + Quoted(file_.unit_text) +
                      ", an unknown unit; give length_unit (" + AnyName<LengthUnit>() +
                      ") or length_scale (m) in the manifest",
                  path_};
    }
    if (file_.unit && files != metres_per_unit_) {
      Warn("gives lengths in " + NameOf(*file_.unit) + "; they are read as " +
           LengthText(metres_per_unit_));
    }
  }

  // Metres per unit as a reader is told who does not have to believe the file; the first one
  // counts.
  std::optional<double> MetresGiven() const {
    for (const GivenLength* said :
         {&options_.length, &entry_.length, &manifest_.length, &mapping_.length}) {
      if (const std::optional<double> metres = said->Metres()) return metres;
    }
    return std::nullopt;
  }

  void Warn(const std::string& warning) const {
    // The file as the manifest names it: results keep warnings, and not where the data lay.
    WarnOf(entry_.id, entry_.motion[index_] + " " + warning, warnings_, "the file " + warning);
  }

  // The manifest's rate; where it gives none, that of the file.
  void SetRate() {
    const double rate = file_.rate_hz;
    fps_ = entry_.fps;
    if (fps_ > 0.0) {
      if (rate == 0.0 || std::abs(fps_ / rate - 1.0) <= kFrameTimeTolerance) return;
      return Warn("has a frame time of " + Rounded(1.0 / rate) + " s (" + Rounded(rate) +
                  " frames per second), the manifest gives " + Rounded(fps_) +
                  " frames per second; the manifest's value is used");
    }
    if (rate == 0.0) {
      throw Error{
          "neither the file nor the manifest gives the frame rate; give fps in the manifest",
          path_};
    }
    fps_ = WholeFrameRate(rate);
    const std::string problem = FrameRateProblem(fps_);
    if (problem.empty()) return;
    throw Error{"the file's frame rate " + problem + "; give the right one as fps in the manifest",
                path_};
  }

  void Cut() {
    const int frames = static_cast<int>(file_.positions[0].size());
    if (entry_.frames && *entry_.frames != frames) {
      throw Error{StrCat("wrong frame count: the file has ", frames, " frames, the manifest gives ",
                         *entry_.frames),
                  path_};
    }
    const int end = entry_.end_frame.value_or(frames);
    if (end > frames || entry_.first_frame >= end) {
      throw Error{StrCat("the file has ", frames, " frames, too few for first_frame ",
                         entry_.first_frame, " and end_frame ", end),
                  path_};
    }
    for (Track& track : file_.positions) {
      track.resize(end);
      track.erase(track.begin(), track.begin() + entry_.first_frame);
    }
  }

  // A frame loses weight only by gaps of hip and ankles.
  void CloseGaps(RecordedPerson* person) {
    const int frames = static_cast<int>(file_.positions[0].size());
    const int max_gap = static_cast<int>(std::floor(options_.preparation.max_gap_s * fps_ + 1e-9));
    std::vector<double> unused(frames, 1.0);
    std::vector<Track*> counting;
    for (std::size_t i = 0; i < file_.positions.size(); ++i) {
      Track& track = file_.positions[i];
      const auto holds = [i](const std::vector<int>& joints) {
        return std::find(joints.begin(), joints.end(), static_cast<int>(i)) != joints.end();
      };
      if (std::any_of(std::begin(kPendulumTracks), std::end(kPendulumTracks), [&](const auto& row) {
            return row.required && holds(places_.*row.joints);
          })) {
        counting.push_back(&track);
        if (!NeverSeen(track)) continue;
        throw Error{file_.names[file_.chosen[i]] + " is never seen; choose another by \"joints\"",
                    path_};
      }
      const GapCount count = FillGaps(max_gap, &track, &unused);
      // A toe or heel that is lost for long says nothing of where the foot stands, and a marker
      // that is never seen plays no role.
      for (const PendulumTrack& row : kPendulumTracks) {
        std::vector<int>& joints = places_.*row.joints;
        if (count.excluded_frames > 0 && !row.required && holds(joints)) joints.clear();
      }
      if (count.excluded_frames < frames) continue;
      for (std::vector<int>& joints : roles_.joints) {
        if (holds(joints)) joints.clear();
      }
      for (std::vector<int>* joints : {&roles_.left_asis, &roles_.right_asis, &roles_.back}) {
        if (holds(*joints)) joints->clear();
      }
    }
    FilledTracks filled = FillTracks(max_gap, counting);
    std::vector<double>& weight = filled.weight;
    if (filled.gaps == 0) return;
    if (weight[0] == 0.0) {
      const auto seen = std::find(weight.begin(), weight.end(), 1.0);
      throw Error{StrCat("at frame ", entry_.first_frame,
                         ", where the fit starts, hip or ankles are missing; ",
                         seen == weight.end() ? std::string("no frame shows them all")
                                              : StrCat("set first_frame to ",
                                                       entry_.first_frame + (seen - weight.begin()),
                                                       " or later in the manifest")),
                  path_};
    }
    Warn(filled.Warning(options_.preparation.max_gap_s));
    if (!filled.AllCount()) person->weight = std::move(weight);
  }

  void Turn(RecordedPerson* person) {
    const bool own =
        mapping_.up.empty() || entry_.json->contains("up") || entry_.json->contains("forward");
    person->file_up = own ? entry_.up : mapping_.up;
    person->file_forward = own ? entry_.forward : mapping_.forward;
    const Eigen::Matrix3d axes = OrThrow(AxesRotation(person->file_up, person->file_forward));
    if (file_.skeleton != nullptr && options_.keep_all_joints) {
      person->skeleton =
          FileSkeleton{*file_.skeleton, std::move(file_.values), metres_per_unit_, axes};
    }
    for (Track& track : file_.positions) {
      for (Eigen::Vector3d& position : track) position = axes * position;
    }
  }

  void Take(RecordedPerson* person) {
    for (const PendulumTrack& row : kPendulumTracks) {
      person->*row.track = MeanTrack(file_.positions, places_.*row.joints);
    }
    if (!options_.keep_all_joints) return;
    for (int joint : file_.chosen) {
      person->joint_names.push_back(file_.names[joint]);
      person->joint_parents.push_back(
          file_.skeleton != nullptr ? file_.skeleton->joints[joint].parent : -1);
    }
    person->roles = roles_;
    const std::vector<int> filled = FilledRoles(roles_);
    if (!filled.empty() && UnfilledRoles(roles_).empty()) {
      Warn(
          "has no joints for " + RoleList(filled) +
          ", which are filled from their neighbours; name them by \"joints\" if the file has them");
    }
    person->joints = Transposed(file_.positions);
  }

  const Manifest& manifest_;
  const ManifestRecording& entry_;
  const std::size_t index_;
  const LoadOptions& options_;
  Warnings* const warnings_;
  std::string path_;
  ColumnMapping mapping_;
  JointMapping joints_;
  PointMotion file_;       // the points that are read, in metres; whatever its format
  PendulumJoints places_;  // indices into its positions
  BodyRoles roles_;        // set with all joints: who plays which role
  double metres_per_unit_ = 0.0;
  std::string mapping_hash_;
  double fps_ = 0.0;
};

constexpr double kUnseenStance = 0.1;  // m, of ankles that nobody saw

// The person of a recording without motion, for as long as their platforms measured.
LoadedPerson LoadPersonOnPlates(const ManifestRecording& entry) {
  const ManifestPlates& plates = entry.plates[0];
  const ManifestSubject& subject = entry.subjects[0];
  LoadedPerson loaded;
  RecordedPerson& person = loaded.person;
  const PlateTracks tracks = ReadPlates(entry, plates, person);
  person.subject_id = subject.id;
  person.mass_kg = subject.mass_kg;
  person.known = subject.known;
  person.file = tracks.file;
  person.file_clock_s = plates.start_s.value_or(tracks.first_s);
  person.skipped_s = person.file_clock_s - tracks.first_s;
  loaded.fps = entry.fps > 0.0 ? entry.fps : WholeFrameRate(tracks.rate_hz);
  const std::string problem = FrameRateProblem(loaded.fps);
  if (!problem.empty()) {
    throw Error{"the platforms' rate " + problem + "; give fps in the manifest", tracks.file};
  }
  const double seconds = tracks.last_s() - person.file_clock_s;
  const int frames = 1 + static_cast<int>(std::floor(seconds * loaded.fps + 1e-6));
  if (!(seconds > 0.0) || frames < 3) {
    throw Error{"the platforms were recorded from " + Rounded(tracks.first_s, 4) + " to " +
                    Rounded(tracks.last_s(), 4) + " s, which leaves nothing after \"start\" (" +
                    Rounded(person.file_clock_s, 4) + " s)",
                tracks.file, tracks.last_line};
  }
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& row : tracks.moment) moment += row;
  Eigen::Vector3d ankles(0.0, 0.0, subject.ankle_height_m);
  if (moment.z() > 0.0) ankles.head<2>() = moment.head<2>() / moment.z();
  person.hip.assign(frames, ankles + Eigen::Vector3d(0.0, 0.0, subject.rod_m));
  person.left_ankle.assign(frames, ankles + Eigen::Vector3d(0.0, kUnseenStance, 0.0));
  person.right_ankle.assign(frames, ankles - Eigen::Vector3d(0.0, kUnseenStance, 0.0));
  person.weight.assign(frames, 0.0);
  loaded.file_hash = OrThrow(HashFile(tracks.file));
  OrThrow(CheckMotion(person, 1.0));
  return loaded;
}

Recording Load(const Manifest& manifest, const ManifestRecording& entry, const LoadOptions& options,
               Warnings* warnings) {
  Recording recording;
  recording.SetFacts(entry);
  for (const std::string& misspelt : MisspeltKeys(entry)) {
    if (warnings == nullptr) continue;
    warnings->emplace_back("recording " + Quoted(entry.id) + " " + misspelt, entry.id, misspelt);
  }
  if (entry.plates_alone && !options.plates_alone) {
    throw Error{
        "was measured by force plates alone (\"motion\": \"none\"), which only pushid-fit "
        "(--stance=fixed) and pushid-inspect can use; leave it out (--leave_out), or name "
        "the files of its motion",
        entry.manifest, entry.line};
  }
  ContentHash hash;  // of the files' hashes, so that contents cannot slide from one into the next
  for (std::size_t i = 0; i < entry.subjects.size(); ++i) {
    LoadedPerson loaded = entry.plates_alone
                              ? LoadPersonOnPlates(entry)
                              : PersonLoader(manifest, entry, i, options, warnings).Load();
    hash.Add(loaded.file_hash);
    RecordedPerson& person = loaded.person;
    if (i == 0) recording.fps = loaded.fps;
    if (loaded.fps != recording.fps) {
      throw Error{"the file gives " + Rounded(loaded.fps) + " frames per second, but " +
                      recording.people[0].file + " gives " + Rounded(recording.fps) +
                      "; give the right one as fps in the manifest",
                  person.file};
    }
    if (i > 0 && person.hip.size() != recording.people[0].hip.size()) {
      throw Error{StrCat("the file has ", person.hip.size(), " frames, but ",
                         recording.people[0].file, " has ", recording.people[0].hip.size(),
                         "; the people of one recording share their frames"),
                  person.file};
    }
    recording.people.push_back(std::move(person));
  }
  std::vector<ManifestPush> pushes = entry.pushes;
  if (!entry.push_csv.empty()) {
    pushes.insert(pushes.begin(), ManifestPush{entry.pushed_person, entry.push_csv, 0});
  }
  for (const ManifestPush& push : pushes) LoadPush(entry, push, &hash, &recording, warnings);
  recording.content_hash = hash.Hex();
  OrThrow(PrepareMotion(options.preparation, &recording));
  if (entry.ground.given()) {
    recording.ground = OrThrow(LoadGround(entry, recording, options.preparation.lowpass_hz));
  }
  for (const ManifestPlates& plates : entry.plates) {
    LoadPlates(entry, plates, options.preparation.lowpass_hz, &recording, warnings);
  }
  return recording;
}

}  // namespace

Result<Recording> LoadRecording(const Manifest& manifest, const ManifestRecording& entry,
                                const LoadOptions& options, Warnings* warnings) {
  Result<Recording> loaded = Caught([&] { return Load(manifest, entry, options, warnings); });
  if (loaded.ok()) return loaded;
  Error error = loaded.error();
  error.message = "recording " + Quoted(entry.id) + ": " + error.message;
  return error;
}

Result<std::vector<Recording>> LoadRecordings(const std::string& manifests,
                                              const LoadOptions& options, Warnings* warnings) {
  return Caught([&] {
    OrThrow(CheckPreparation(options.preparation));
    return OrThrow(LoadRecordings(OrThrow(ReadManifests(manifests)), options, warnings));
  });
}

Result<std::vector<Recording>> LoadRecordings(const Manifest& manifest, const LoadOptions& options,
                                              Warnings* warnings) {
  return Caught([&] {
    OrThrow(CheckPreparation(options.preparation));
    std::vector<Recording> recordings;
    for (int index :
         OrThrow(SelectRecordings(manifest, options.setting, options.ids, options.leave_out))) {
      recordings.push_back(
          OrThrow(LoadRecording(manifest, manifest.recordings[index], options, warnings)));
    }
    return recordings;
  });
}

}  // namespace pushid
