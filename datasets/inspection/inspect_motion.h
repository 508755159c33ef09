// datasets: what can be seen of a motion before anything is fitted: unit, axes, rate, gaps, jumps,
// standing height, a static start, the onset of the push, steps.
#pragma once

#include <optional>

#include "datasets/formats/point_motion.h"
#include "datasets/inspection/facing_and_steps.h"
#include "datasets/inspection/inspection.h"
#include "datasets/manifest/joint_choice.h"

namespace pushid {

// Adds facts, warnings and the picture's data. `joints`: indices into motion.names, all of which
// were read; without them only rate, gaps and jumps are looked at. pelvis: alike.
void InspectMotion(const PointMotion& motion, const std::optional<PendulumJoints>& joints,
                   const PelvisSides& pelvis, Inspection* inspection);

}  // namespace pushid
