// datasets: inspection of a motion before anything is fitted.
#pragma once

#include <optional>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/formats/point_motion.h"
#include "datasets/inspection/inspection.h"
#include "datasets/manifest/joint_mapping.h"
#include "datasets/manifest/recording.h"

namespace pushid {

// Two points of the pelvis, one on each side, as indices; empty where there are none.
struct PelvisSides {
  std::vector<int> left{}, right{};
  bool known() const { return !left.empty() && !right.empty(); }
};
// The anterior iliac spines, or the hip joints, where the file has them itself.
PelvisSides SidesOf(const Result<BodyRoles>& roles);

// A motion: unit, axes, rate, gaps, jumps, standing height, a static start, the onset of the push,
// steps. Adds facts, warnings and the picture's data. `joints`: indices into motion.names, all of
// which were read; without them only rate, gaps and jumps are looked at. pelvis: alike.
void InspectMotion(const PointMotion& motion, const std::optional<PendulumJoints>& joints,
                   const PelvisSides& pelvis, Inspection* inspection);

}  // namespace pushid
