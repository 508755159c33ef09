// datasets: the meaning of a file's joints, markers and columns: those that the pendulum is read
// from, and those that play the roles of a body; and mapping files.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/formats/bvh.h"
#include "datasets/formats/point_motion.h"
#include "datasets/formats/units.h"
#include "datasets/manifest/manifest.h"
#include "datasets/manifest/recording.h"

namespace pushid {

// Indices into the file's joints or points; each place is the mean of its list.
struct PendulumJoints {
  std::vector<int> hip, left_ankle, right_ankle;
  // Joints of the feet, where the file has them; empty otherwise.
  std::vector<int> left_toe{}, right_toe{}, left_heel{}, right_heel{};
};

// A track of a person: the mean of these joints. Tracks that only the steps of feet need come last.
struct PendulumTrack {
  std::vector<int> PendulumJoints::*joints;
  std::vector<Eigen::Vector3d> RecordedPerson::*track;
  bool required;
};
inline constexpr PendulumTrack kPendulumTracks[] = {
    {&PendulumJoints::hip, &RecordedPerson::hip, true},
    {&PendulumJoints::left_ankle, &RecordedPerson::left_ankle, true},
    {&PendulumJoints::right_ankle, &RecordedPerson::right_ankle, true},
    {&PendulumJoints::left_toe, &RecordedPerson::left_toe, false},
    {&PendulumJoints::right_toe, &RecordedPerson::right_toe, false},
    {&PendulumJoints::left_heel, &RecordedPerson::left_heel, false},
    {&PendulumJoints::right_heel, &RecordedPerson::right_heel, false},
};

// The joints that `mapping` names, and for the rest the defaults:
//   hip     a joint called Hips, Hip or Pelvis, otherwise the first root;
//   ankles  joints called LeftAnkle, LeftFoot, L_Ankle, foot.l, mixamorig:LeftFoot, ... (case and
//           punctuation do not matter); otherwise, in a skeleton with the 22 joints and the parents
//           of the FZJ push recordings, right 16 and left 20;
//   toes    joints called LeftToeBase, LeftToe, L_Toe, ..., or LeftFoot beside a LeftAnkle; in an
//           FZJ skeleton right 17 and left 21;
//   heels   joints called LeftHeel, ...
// Toes and heels are never required: what is not found stays empty.
// Points of other files (no skeleton) may be named without what stands before a colon ("LASI" for
// "Anna:LASI") where that is clear. Their defaults:
//   hip     Hips, Hip or Pelvis, otherwise the mean of the pelvis markers: LASI RASI LPSI RPSI
//           (also as L.ASIS, ASISl, ...), LASI RASI SACR, LASI RASI;
//   ankles  the names above, the middle of both malleoli (L_FAL and L_TAM, LAL and LAM, ...), LANK,
//           L.Ankle.Lat, LMAL, ...
//   toes, heels  the names above, LTOE, L.Toe.Tip, LMT2, LHEE, LCAL, ...: with the ankle's prefix
//           ("Anna:") where several people have them
// Errors: a joint that does not exist (a few that do are listed), no ankles found, one joint twice,
// a default or a short name that several people's points match. `path` is the file, for messages;
// skeleton: null for points.
Result<PendulumJoints> ChoosePendulum(const std::string& path,
                                      const std::vector<std::string>& names,
                                      const BvhSkeleton* skeleton, const JointMapping& mapping);

// `first` where it names a joint, otherwise `second`.
JointMapping Overlaid(const JointMapping& first, const JointMapping& second);

// The joints of the roles: hip, ankles and toes are those of the pendulum and its feet; for the
// rest the words of the naming that knows most of the file's names (joint_mapping.cc has the
// table), and for the spine of a skeleton the joints between hip and shoulders. A skeleton of the
// FZJ push recordings plays the roles as it stands. What `mapping` names wins; a name there that
// the file has not is the only Error: roles that nothing plays stay empty. skeleton: null for
// points, `names` are theirs.
Result<BodyRoles> ChooseRoles(const std::string& path, const std::vector<std::string>& names,
                              const BvhSkeleton* skeleton, const PendulumJoints& pendulum,
                              const JointMapping& mapping);

// "all roles", "all roles, filled from neighbours: ...", or "none: ..." and why, for people.
std::string RolesText(const Result<BodyRoles>& roles);

class JsonFields;

// A mapping file, JSON: what a program's files mean, said once for all recordings made with it.
//
//   {"columns": {"waist": ["wx", "wy", "wz"], "foot_l": ["lx", "ly", "lz"], ...},
//    "joints": {"hip": "waist", "left_ankle": "foot_l", "right_ankle": "foot_r"},
//    "time": "clock", "frame_rate": 100, "length_unit": "cm", "up": "y", "forward": "z"}
//
// Every key is optional. What the manifest says itself wins.
struct ColumnMapping {
  std::vector<PointColumns> columns;
  JointMapping joints;
  std::string time_column;
  double frame_rate = 0.0;  // frames per second; 0: not said
  GivenLength length{};
  std::string up, forward;  // empty: not said
};

// Errors name line and key; keys that are not known are Errors too, since they would do nothing.
Result<ColumnMapping> ReadColumnMapping(const std::string& path);

// Joints and units, which manifests and mapping files write alike.

// "joints": {"hip": "Hips" or 0 or ["LASI", "RASI"], "left_ankle": ..., "left_knee": ...}: any role
// of recording.h, all optional. "base", a robot's base of support, stands for both ankles.
inline constexpr int kBaseRole = -1;  // its key in JointMapping::others
JointMapping ReadJointMapping(JsonFields* fields);

// "length_unit" ("mm", "cm" or "m") or "length_scale", the metres in one of the file's lengths.
// Both keys beside each other are a mistake.
GivenLength ReadLength(JsonFields* fields);

}  // namespace pushid
