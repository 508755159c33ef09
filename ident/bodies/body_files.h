// ident: moving bodies as files: BVH and glTF for animation programs, CSV and JSON of the joints.
//
// Every person moves in the skeleton that they came with (body_recording.h), joint by joint.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/formats/bvh.h"
#include "ident/bodies/body_recording.h"
#include "ident/prediction/predicted_steps.h"
#include "models/restoration/body.h"

namespace pushid {

// Moving people as an animated glTF 2.0 file (Khronos; ISO/IEC 12113), for Blender, the
// viewers of Windows and macOS, web pages and game engines.
//
// One scene with a node per person, under it a node per joint with the joint's name, and at each
// joint an octahedron to every child, and one up from a head; a flat box where a foot of a model
// stands, from its landing to its lift-off. Metres, y up, z forward, x to the
// left (the pushed way is +z). One animation: rotations of all joints, translations of the roots,
// and of other joints where bones change their length, so that every joint stands where it is
// wanted at every frame. Nothing outside the file is needed.

struct GltfPerson {
  std::string name;
  std::vector<std::string> joints;
  std::vector<int> parents;  // -1: a root; every parent precedes its children
  Eigen::Matrix3Xd rest;     // m, a column a joint; there all rotations are zero
  int head = -1;             // the joint that is a head; -1: none
  std::vector<PosedJoints> frames;
};

struct GltfFootprint {
  std::string name;
  int person = 0;               // whose colour it has
  Eigen::Vector3d middle;       // on the ground, m
  double heading = 0.0;         // rad, about the upright from forward
  double length = 0.0;          // m
  double from = 0.0, to = 0.0;  // s
};

struct GltfScene {
  std::string name;
  double dt = 1.0 / 60.0;  // s
  bool y_up = false;       // the people's axes are glTF's already; otherwise z up, x forward
  std::vector<GltfPerson> people;
  std::vector<GltfFootprint> footprints = {};
};

// The ending says how: ".glb" binary, otherwise (".gltf") JSON with the numbers in base64.
MaybeError WriteGltf(const std::string& path, const GltfScene& scene);

// People who move together, under the names that files give them.
struct BodyScene {
  std::string id;
  double dt = 1.0 / 60.0;                // s
  std::vector<std::string> subject_ids;  // one per person
  std::vector<BodySkeleton> skeletons;   // one per person; empty: the 22 roles
  std::vector<BodyMotion> bodies;        // [person][frame], by role
  FootprintsOfPeople footprints = {};    // where a model's feet stand; empty: it has none

  BodySkeleton skeleton(int person) const;
  int num_people() const { return static_cast<int>(bodies.size()); }
  int num_frames() const { return bodies.empty() ? 0 : static_cast<int>(bodies[0].size()); }
};

// Of the recording's people, with other motions of theirs.
BodyScene SceneOf(const BodyRecording& recording, std::vector<BodyMotion> bodies);

// The hierarchy of the BVH file that the person came from: its joints in their order, offsets,
// channels, axes and lengths; a joint whose angles change gets the rotation channels that it lacks,
// and joints without a role keep their angles of frame 0. Without such a file the 22 roles, world
// axes (z up, x forward), millimetres: offsets are differences of joints in the rest, where all
// rotations are zero. Positions that no rotation of these bones can reach are approached as
// FitTree does.
BvhMotion ToBvh(const BodySkeleton& skeleton, const BodyMotion& motion, double dt);

// Everybody in one scene, under the joints' names; footprints as "left foot of S01, 0.42-0.78 s".
GltfScene ToGltf(const BodyScene& scene);

// One file per person: `path` itself for one person, "motion_0_ID.bvh", ... beside it for more.
// Returns the files' names.
Result<std::vector<std::string>> WriteBodyBvh(const std::string& path, const BodyScene& scene);

// Whether a file's name ends as those that hold bodies: .bvh, .gltf or .glb.
bool IsBodyFile(const std::string& path);

// By the ending: .gltf and .glb hold everybody in one file (gltf_file.cc), all others are BVH.
Result<std::vector<std::string>> WriteBodyFiles(const std::string& path, const BodyScene& scene);

// frame,time_s,person,subject,joint,x_m,y_m,z_m
MaybeError WriteJointsCsv(const std::string& path, const BodyScene& scene);

// {"id", "dt_s", "joint_names", "joint_parents", "people": [{"subject", "joints_m": [frame][joint]
// [x, y, z]}]}; numbers to a hundredth of a millimetre. A person whose joints are not those of the
// first has joint_names and joint_parents too.
nlohmann::ordered_json ToJson(const BodyScene& scene);

}  // namespace pushid
