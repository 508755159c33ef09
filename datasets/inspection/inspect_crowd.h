// datasets: what trajectories of a crowd hold: people, times, how close they stand.
#pragma once

#include "datasets/formats/point_motion.h"
#include "datasets/inspection/inspection.h"

namespace pushid {

// motion: of every person, as trajectories.h reads them.
void InspectCrowd(const PointMotion& motion, Inspection* found);

}  // namespace pushid
