// ident: recordings with whole bodies and their skeletons, and the inputs of a restoration.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/formats/bvh.h"
#include "datasets/loading/pendulum_recording.h"
#include "datasets/manifest/recording.h"
#include "ident/prediction/prediction.h"
#include "models/restoration/body.h"
#include "models/restoration/restoration.h"

namespace pushid {

// The joints that a person came with, and how they go with the 22 roles of a body.
//
// Bodies are predicted by role (datasets/manifest/recording.h); a motion is then taken back to the
// skeleton it came from. Its joints turn so that those with a role come as near as bones of
// constant length can to where the body wants them (FitTree); a joint without a role
// follows its parent.
struct BodySkeleton {
  std::vector<std::string> names;
  std::vector<int> parents;  // -1: a root; every parent precedes its children
  std::vector<int> roles;    // the role that a joint plays; -1: none
  // Positions at frame 0, m, world: the joints, then the filled roles beyond the last joint of a
  // limb (toes, head), which the joint before them turns towards.
  Eigen::Matrix3Xd rest;
  JointAims tree;
  std::vector<int> wanted_roles;                  // by column of rest; -1: nothing is wanted of it
  Eigen::Vector3d hip = Eigen::Vector3d::Zero();  // the body's, in the rest
  std::optional<FileSkeleton> file;               // of a BVH file, whose hierarchy is kept

  int num_joints() const { return static_cast<int>(names.size()); }
};

// "Hips", "Spine", ...: where a recording gives no names.
std::vector<std::string> DefaultJointNames();

// The 22 roles themselves, as they stand in a pose.
BodySkeleton RoleSkeleton(const Pose& first);

// The skeleton of a person read with all joints: the hierarchy of a BVH file; of points, the 22
// roles.
BodySkeleton SkeletonOf(const RecordedPerson& person);

// A body's pose by the joints: positions of those with a role where the body has it, of the others
// by their parent's rotation.
FittedTree Retarget(const BodySkeleton& skeleton, const Pose& pose);

struct BodyRecording {
  PendulumRecording pendulum;
  std::vector<BodyMotion> bodies;        // one per person, by role
  std::vector<std::string> joint_names;  // of the 22 roles, as the first person's file has them
  std::vector<BodySkeleton> skeletons;   // one per person, of the file

  int num_frames() const { return pendulum.num_frames(); }
  int num_people() const { return pendulum.num_people(); }
};

// The recording must have been read with all joints. Errors: roles that no joint of a skeleton
// plays and that its neighbours do not fill (datasets/manifest/recording.h).
Result<BodyRecording> MakeBodyRecording(const Recording& recording);
Result<std::vector<BodyRecording>> MakeBodyRecordings(const std::vector<Recording>& recordings);
std::vector<PendulumRecording> PendulumsOf(const std::vector<BodyRecording>& recordings);

// Predicted pendulums of people in their first poses: q, rods that move, and whether feet stand,
// where the prediction says so.
void FollowPrediction(const Prediction& prediction, std::vector<RestorationInput>* people);

// People of a recording with predicted pendulums and the first poses that the prediction has seen.
std::vector<RestorationInput> PredictedPeople(const BodyRecording& recording,
                                              const Prediction& prediction);
// People with their recorded pendulums, after `observed` poses. rod_moves: beside predictions whose
// rods move, the rod has the recorded length of each frame, so that its tip is the recorded hip;
// otherwise that of frame 0.
std::vector<RestorationInput> RecordedPeople(const BodyRecording& recording, bool rod_moves,
                                             int observed = 0);

// Moving bodies as files: BVH for animation programs, CSV of the joints.
//
// Every person moves in the skeleton that they came with (body_recording.h), joint by joint.

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
