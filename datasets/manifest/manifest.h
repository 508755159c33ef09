// datasets: the manifest, a JSON file that lists recordings and says what is known about each.
//
//   {"recordings": [{
//     "id": "s1_00", "setting": "single", "fps": 60,
//     "subjects": [{"id": "s1", "mass_kg": 67.0}], "pushed_person": 0,
//     "bvh": ["bvh/s1_00.bvh"], "push_csv": "push/s1_00.csv",
//     "push_kind": "external", "magnitude": "weak"}]}
//
// The room's README has the table of its keys: which are required, and what the others default to.
// All required keys that are missing are told of in one error. A given fps wins over the file, with
// a warning where they differ by more than 0.1 %; keys that no program knows are kept when a
// manifest is written again, and count as labels where they are texts. Older manifests give the
// unit for all recordings as units.bvh_length, and `condition` as condition_code.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/files/kept_json.h"
#include "datasets/formats/motion_formats.h"
#include "datasets/formats/units.h"
#include "datasets/manifest/laboratory_keys.h"
#include "datasets/manifest/recording.h"

namespace pushid {

// A joint or marker by name or, where the manifest gives a number, by index in file order; or the
// mean of several.
struct JointReference {
  std::string name;
  int index = -1;                         // used when the name is empty
  std::vector<JointReference> mean_of{};  // not empty: their mean, and nothing else is used
};

// The joints that the pendulum is read from, and those that play the body's other roles; whatever
// is absent is found by default (joint_mapping.h).
struct JointMapping {
  std::map<int, JointReference> of_role;  // recording.h, or kBaseRole

  // The base stands for ankles that are not named.
  std::optional<JointReference> Of(int role) const;
  void Set(int role, const JointReference& joint) { of_role[role] = joint; }
};

// The published manifests' key for `condition`; read where that is not there, never written.
inline constexpr char kOldConditionKey[] = "condition_code";

inline constexpr double kHeaviestPerson = 400.0;  // kg

// Height of an adult's ankles above the ground, m, where nobody measured it.
inline constexpr double kUsualAnkleHeight = 0.08;

struct ManifestSubject {
  std::string id;
  double mass_kg = 0.0;
  JointMapping joints{};  // before those of the recording
  // Rod of a person whom platforms alone measured, m.
  double rod_m = 0.0, ankle_height_m = kUsualAnkleHeight;
  PersonFacts known{};  // under keys that no program knows
};

struct ManifestPush {
  int person = 0;
  std::string csv;  // relative to the manifest
  int start_frame = 0;
};

struct ManifestRecording : RecordingFacts {
  double fps = 0.0;  // 0: as the motion's files say
  std::vector<ManifestSubject> subjects;
  MotionFormat motion_format = MotionFormat::kBvh;
  std::vector<std::string> motion;      // files, one per subject, relative to the manifest
  bool plates_alone = false;            // "motion": "none": there are no such files
  std::string mapping;                  // relative to the manifest; empty: none
  std::string push_csv;                 // relative to the manifest; empty: no push at frame 0
  std::optional<double> push_height_m;  // of pushes whose files have no torques; unset: the hip
  JointMapping joints;
  std::string up = "z";       // axis of the BVH that points up
  std::string forward = "x";  // axis of the BVH that points forward, in the push direction
  GivenLength length{};
  std::vector<ManifestPush> pushes;
  ManifestGround ground;
  std::vector<ManifestPlates> plates;
  std::optional<int> frames;     // checked against the file when given
  int first_frame = 0;           // of the file, from 0, that becomes frame 0
  std::optional<int> end_frame;  // of the file, behind the last one used
  std::string manifest;          // the file it stands in, whose folder its files are named from
  int line = 0;                  // where it starts there, for messages

  // The entry as read, with the keys this program does not know. Writing starts from it and sets
  // the fields above on top.
  KeptJson json{};
};

// The entry of a recording without its subjects, files and pushes, which are the caller's.
ManifestRecording EntryOf(const Recording& recording);

struct Manifest {
  std::string path;      // the file (or files) it was read from, for messages
  GivenLength length{};  // of recordings that do not give their own
  std::vector<ManifestRecording> recordings;
  KeptJson json;  // the top level, without `recordings`
};

// Reads and checks a manifest; does not open the files it names. Errors name file, line and
// recording: JSON syntax (with column), missing or mistyped keys, duplicate ids, no recordings,
// mass not in (0, 400] kg, fps not in [1, 10000], pushed_person out of range, not as many motion
// files as subjects. All required keys that a recording lacks are in one error, with the number of
// other recordings that have errors.
Result<Manifest> ReadManifest(const std::string& path);

// Writes atomically. A field that equals its default is written only where the JSON already has it;
// push_kind is always written.
MaybeError WriteManifest(const std::string& path, const Manifest& manifest);

// "push/a.csv" as named by the manifest at `manifest_path`: relative to its folder unless absolute.
std::string ResolvePath(const std::string& manifest_path, const std::string& file);
// The other way: the name of a file in that manifest.
std::string PathFromManifest(const std::string& manifest_path, const std::string& file);

// The entry with one of its keys set, read anew: "ground.csv" is csv under ground. value: JSON, or
// else a text. Errors: those of ReadManifest.
Result<ManifestRecording> WithKey(const ManifestRecording& recording, const std::string& key,
                                  const std::string& value);

// Keys of a recording that this program knows.
const std::vector<std::string>& ManifestKeys();

// "has the key 'push_scv', which is not known and not used; did you mean push_csv?" for each. Keys
// that are like no known one are a user's own, and fine.
std::vector<std::string> MisspeltKeys(const ManifestRecording& entry);

// The recordings that a run uses: indices into manifest.recordings, in the manifest's order.
//
// `setting` as --setting spells it: "all", or a comma-separated list of the manifest's settings and
// "groups" (recordings of more than one person). `ids`: only these; empty: no restriction.
// `leave_out`: not these of them. A setting or id that does not exist is an Error that lists what
// does.
Result<std::vector<int>> SelectRecordings(const Manifest& manifest, const std::string& setting,
                                          const std::vector<std::string>& ids,
                                          const std::vector<std::string>& leave_out = {});

// Several manifests as one, as --recordings=a.json,b.json names them.

// "a.json,b.json": each; a file whose own name has a comma stands for itself.
std::vector<std::string> ManifestPaths(const std::string& list);

// The recordings of all of them, in their order; a unit that stands beside `recordings` goes into
// its recordings. Errors besides those of ReadManifest: an id in two of them, a person of one mass
// here and of another there.
Result<Manifest> ReadManifests(const std::string& list);

// HashFile of the one, or a hash of their hashes.
Result<std::string> HashManifests(const std::string& list);

}  // namespace pushid
