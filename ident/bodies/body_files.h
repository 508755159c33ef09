// ident: moving bodies as files: BVH for animation programs, CSV of the joints.
//
// Every person moves in the skeleton that they came with (body_recording.h), joint by joint.
#pragma once

#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/formats/bvh.h"
#include "ident/bodies/body_recording.h"
#include "models/restoration/body.h"

namespace pushid {

// People who move together, under the names that files give them.
struct BodyScene {
  std::string id;
  double dt = 1.0 / 60.0;                // s
  std::vector<std::string> subject_ids;  // one per person
  std::vector<BodySkeleton> skeletons;   // one per person; empty: the 22 roles
  std::vector<BodyMotion> bodies;        // [person][frame], by role

  BodySkeleton skeleton(int person) const;
  int num_people() const { return static_cast<int>(bodies.size()); }
  int num_frames() const { return bodies.empty() ? 0 : static_cast<int>(bodies[0].size()); }
};

// A scene of the recording's people with other motions.
BodyScene SceneOf(const BodyRecording& recording, std::vector<BodyMotion> bodies);

// The hierarchy of the BVH file that the person came from: its joints in their order, offsets,
// channels, axes and lengths; a joint whose angles change gets the rotation channels that it lacks,
// and joints without a role keep their angles of frame 0. Without such a file the 22 roles, world
// axes (z up, x forward), millimetres: offsets are differences of joints in the rest, where all
// rotations are zero. Positions that no rotation of these bones can reach are approached as
// FitTree does.
BvhMotion ToBvh(const BodySkeleton& skeleton, const BodyMotion& motion, double dt);

// One file per person: `path` itself for one person, "motion_0_ID.bvh", ... beside it for more.
// Returns the files' names.
Result<std::vector<std::string>> WriteBodyBvh(const std::string& path, const BodyScene& scene);

bool IsBodyFile(const std::string& path);

// frame,time_s,person,subject,joint,x_m,y_m,z_m
MaybeError WriteJointsCsv(const std::string& path, const BodyScene& scene);

}  // namespace pushid
