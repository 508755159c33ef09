// datasets: a folder of motion-capture clips by action, as particles.
//
//   FOLDER/skeleton.json               joints, parents, offsets_mm, used, duplicates, mirror
//   FOLDER/train/walking/walking_1.txt  clips to learn from; FOLDER/test/... those kept apart
//
// Of a folder without train and test the actions stand in it directly; skeleton.json may stand one
// folder higher. Joints are particles where they are `used`; `duplicates` share the place of a used
// one and count in means over all joints, the others never move and only count as right.
#pragma once

#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "models/particles.h"

namespace pushid {

struct MocapSkeleton {
  JointTree tree;
  std::vector<int> used;  // the joint of each particle
  ParticleLayout layout;
};

struct MocapClip {
  std::string action, name;  // "walking", "walking_1"
  Trajectories motion;       // at the file's rate, twice the protocol's
  std::string content_hash;
  bool is_test = false;  // below test/
};

struct MocapFolder {
  MocapSkeleton skeleton;
  std::vector<MocapClip> clips;  // by action, then by number
};

Result<MocapSkeleton> ReadMocapSkeleton(const std::string& path);

// Errors: no skeleton, no clips, a clip that is malformed (file, line, column).
Result<MocapFolder> ReadMocapFolder(const std::string& folder);

}  // namespace pushid
