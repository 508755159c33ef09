// datasets: which joints of a skeleton the pendulum is read from.
#pragma once

#include <string>

#include "datasets/bvh.h"
#include "datasets/manifest.h"
#include "datasets/result.h"

namespace pushid {

struct PendulumJoints {
  int hip = 0, left_ankle = 0, right_ankle = 0;  // indices into the skeleton
};

// What `mapping` names, and for the rest the defaults:
//   hip     a joint called Hips, Hip or Pelvis, otherwise the first root;
//   ankles  joints called LeftAnkle, LeftFoot, L_Ankle, foot.l, mixamorig:LeftFoot, ... (case and
//           punctuation do not matter); otherwise, in a skeleton with the 22 joints and the parents
//           of the FZJ push recordings, right 16 and left 20.
// Errors: a joint that does not exist (a few that do are listed), no ankles found, one joint twice.
// `path` is the BVH file, for messages.
Result<PendulumJoints> ChoosePendulumJoints(const std::string& path, const BvhSkeleton& skeleton,
                                            const JointMapping& mapping);

}  // namespace pushid
