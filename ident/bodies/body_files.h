// ident: moving bodies as files: BVH for animation programs, CSV and JSON of the joints.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/formats/bvh.h"
#include "models/restoration/body.h"

namespace pushid {

// People who move together, under the names that files give them.
struct BodyScene {
  std::string id;
  double dt = 1.0 / 60.0;                // s
  std::vector<std::string> subject_ids;  // one per person
  std::vector<std::string> joint_names;  // 22
  std::vector<BodyMotion> bodies;        // [person][frame]

  int num_people() const { return static_cast<int>(bodies.size()); }
  int num_frames() const { return bodies.empty() ? 0 : static_cast<int>(bodies[0].size()); }
};

// "Hips", "Spine", ...: where a recording gives no names.
std::vector<std::string> DefaultJointNames();

// A hierarchy whose rest pose is the motion's first: offsets are differences of joints there, all
// rotations zero. World axes (z up, x forward), millimetres. Positions that no rotation of these
// bones can reach are approached as skeleton_fit.h does.
BvhMotion ToBvh(const BodyMotion& motion, const std::vector<std::string>& joint_names, double dt);

// One file per person: `path` itself for one person, "motion_0_ID.bvh", ... beside it for more.
// Returns the files' names.
Result<std::vector<std::string>> WriteBodyBvh(const std::string& path, const BodyScene& scene);

// frame,time_s,person,subject,joint,x_m,y_m,z_m
MaybeError WriteJointsCsv(const std::string& path, const BodyScene& scene);

// {"id", "dt_s", "joint_names", "joint_parents", "people": [{"subject", "joints_m": [frame][joint]
// [x, y, z]}]}; numbers to a hundredth of a millimetre.
nlohmann::ordered_json ToJson(const BodyScene& scene);

}  // namespace pushid
