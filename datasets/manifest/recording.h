// datasets: one push recording in SI units, whatever the files behind it looked like.
// World: z up, x forward (the push direction), y left; metres, seconds, newtons, radians.
#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "datasets/formats/bvh.h"
#include "datasets/manifest/laboratory_keys.h"
#include "models/enum_names.h"
#include "models/ground.h"
#include "models/push.h"  // PushKind
#include "models/restoration/body.h"

namespace pushid {

// The joints or markers of a file as the 22 joints of a body (models/restoration/body.h):
// whatever a skeleton calls its joints, and however many it has, they play roles.
//
// A role that a file lacks is filled from its neighbours, frame by frame, where those say enough:
//   neck           between the shoulders, where head and neck are both lacking;
//   spine, neck    evenly along the straight line between the next ones below and above;
//   head           beyond the neck, on the line from the upper spine;
//   clavicles      half-way from the upper spine to the shoulder;
//   hip joints     from the pelvis markers, by the regression of Bell, Pedersen and Brand (J.
//                  Biomechanics 23, 1990): 36 % of the distance between the anterior iliac spines
//                  to the side, 19 % back and 30 % down from their middle;
//   toes           in front of the ankle, square to the line between the hip joints.

// Names of the kBodyJoints, in their order: "hip", "lower_spine", ..., "right_clavicle", ...,
// "left_toe".
const std::vector<std::string>& RoleNames();
inline const std::string& RoleName(int role) { return RoleNames()[role]; }

struct BodyRoles {
  // Indices into the joints; a role is the mean of its list. Empty: the file lacks it.
  std::array<std::vector<int>, kBodyJoints> joints;
  // Anterior iliac spines and the middle of the posterior ones (or the sacrum), for hip joints that
  // are lacking; empty: not known.
  std::vector<int> left_asis{}, right_asis{}, back{};

  bool Has(int role) const { return !joints[role].empty(); }
  // The joint that plays the role by itself; -1: none.
  int Single(int role) const { return joints[role].size() == 1 ? joints[role][0] : -1; }
};

// Roles that are lacking and that no neighbour fills; empty: there is a body.
std::vector<int> UnfilledRoles(const BodyRoles& roles);
// Roles that are lacking and filled.
std::vector<int> FilledRoles(const BodyRoles& roles);
// "left_knee, right_knee".
std::string RoleList(const std::vector<int>& roles);

// A frame's joints, m, z up, as a body; nothing may be unfilled.
Pose PoseOf(const BodyRoles& roles, const std::vector<Eigen::Vector3d>& joints);

// The labels of a recording: texts by which recordings are chosen, grouped and pooled.

// Keys that programs know; a manifest may give a recording any others.
inline constexpr char kSettingLabel[] = "setting";      // the arrangement: single, row_1, ...
inline constexpr char kMagnitudeLabel[] = "magnitude";  // strength of the push: weak, strong, ...
inline constexpr char kConditionLabel[] = "condition";  // of the protocol

class RecordingLabels {
 public:
  // The text of a label; empty where the recording has none.
  const std::string& Of(const std::string& key) const {
    static const std::string kNone;
    const auto found = labels_.find(key);
    return found == labels_.end() ? kNone : found->second;
  }
  const std::string& setting() const { return Of(kSettingLabel); }
  const std::string& magnitude() const { return Of(kMagnitudeLabel); }
  const std::string& condition() const { return Of(kConditionLabel); }

  // An empty text takes the label away.
  void Set(const std::string& key, std::string text) {
    if (text.empty()) {
      labels_.erase(key);
    } else {
      labels_[key] = std::move(text);
    }
  }

  std::vector<std::string> Keys() const {
    std::vector<std::string> keys;
    for (const auto& [key, text] : labels_) keys.push_back(key);
    return keys;
  }

 private:
  std::map<std::string, std::string> labels_;
};

// Velocity of the pendulum at frame 0.
enum class InitialVelocity {
  kZero,       // at rest (the published pushes were computed so)
  kEstimated,  // backward difference of frames 1 and 0
  kFree,       // fitted
};
constexpr EnumNames<InitialVelocity, 3> Names(InitialVelocity) {
  return {{{"zero", InitialVelocity::kZero},
           {"estimated", InitialVelocity::kEstimated},
           {"free", InitialVelocity::kFree}}};
}

// Facts about a recording as a whole, which its entry in a manifest gives.
struct RecordingFacts {
  std::string id;
  RecordingLabels labels;
  int pushed_person = 0;
  PushKind push_kind = PushKind::kExternal;
  InitialVelocity initial_velocity = InitialVelocity::kZero;
  StatedErrors stated_errors;

  void SetFacts(const RecordingFacts& facts) { *this = facts; }
};

// A generalized force [fx N, fy N, ftheta N m, fphi N m]; row i drives the step from frame
// start_frame + i to the next.
struct Push {
  int person = 0;
  int start_frame = 0;
  std::vector<Eigen::Vector4d> force;
  std::string file;  // where it was read, for messages

  int EndFrame() const { return start_frame + static_cast<int>(force.size()); }
};

// The hierarchy of a BVH file as it stands at frame 0, so that a motion can be given back in it.
struct FileSkeleton {
  BvhSkeleton bvh;             // offsets in the file's lengths and axes
  std::vector<double> values;  // of all channels at frame 0
  double metres_per_unit = 1.0;
  Eigen::Matrix3d world_from_file = Eigen::Matrix3d::Identity();
};

// The sum of all force platforms under a person at one frame, in the axes of the ground, with which
// they move.
struct PlateSample {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   // on the person, N
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  // of pressure, m
  double weight = 0.0;                               // in [0, 1]: 0 where nothing was measured
};

// Facts about a person beside the mass, under keys of the user's own: numbers that a fit may take
// as covariates (age, height), and texts by which people are compared (group).
struct PersonFacts {
  std::map<std::string, double> numbers;
  std::map<std::string, std::string> texts;
};

struct RecordedPerson {
  std::string subject_id;
  double mass_kg = 0.0;
  PersonFacts known;
  std::string file;  // of the motion
  // The clock of that file at frame 0 (s), the time before frame 0 that first_frame leaves out (s),
  // and the file's axes: forces that were recorded in this file or beside it need them.
  double file_clock_s = 0.0, skipped_s = 0.0;
  std::string file_up = "z", file_forward = "x";
  // Joint positions, one entry per frame, metres.
  std::vector<Eigen::Vector3d> hip, left_ankle, right_ankle;
  // Tracks of the feet; empty where the file has none, or loses them for longer than a filled gap.
  std::vector<Eigen::Vector3d> left_toe, right_toe, left_heel, right_heel;
  // One per frame in [0, 1]: how much the frame counts; empty: 1 for all. 0 where hip or ankles
  // were not seen: the positions there mean nothing.
  std::vector<double> weight;
  // One per frame; empty: no platform is to be measured against.
  std::vector<PlateSample> plates;
  // Positions of all joints, [frame][joint]; empty unless asked for.
  std::vector<std::vector<Eigen::Vector3d>> joints;
  // Names and parents (-1 for a root) of `joints`; empty unless those were asked for.
  std::vector<std::string> joint_names;
  std::vector<int> joint_parents;
  // The joints that play the roles of a body; no role where they were not asked for.
  BodyRoles roles;
  std::optional<FileSkeleton> skeleton;  // of a BVH file, beside its joints
};

struct Recording : RecordingFacts {
  double fps = 0.0;
  std::vector<RecordedPerson> people;
  std::vector<Push> pushes;
  std::vector<GroundPose> ground;  // one per frame, in the laboratory; empty: it does not move
  std::string content_hash;        // of every file it was read from, for provenance

  int num_frames() const { return people.empty() ? 0 : static_cast<int>(people[0].hip.size()); }
};

}  // namespace pushid
