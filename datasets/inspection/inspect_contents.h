// datasets: what a file holds besides one person's motion: forces, a crowd, a manifest.
#pragma once

#include <string>
#include <vector>

#include "datasets/formats/c3d.h"
#include "datasets/formats/point_motion.h"
#include "datasets/inspection/inspection.h"

namespace pushid {

// Peak, impulse and onset of a force in N; keeps it for the picture. NaN: no value.
void AddForce(const std::string& name, double rate_hz, std::vector<double> values,
              Inspection* found);

// What a sensor of one number reads at rest (the median of the first and last tenth of its samples)
// is said and taken off where it is more than a hundredth of its peak.
void TakeOffRest(std::vector<double>* force, Inspection* found);

// The analog channels of a C3D file, and what presses its force platforms.
void LookAtAnalog(const C3dFile& file, Inspection* found);
void LookAtPlatforms(const C3dFile& file, Inspection* found);

// What trajectories of a crowd hold: people, times, how close they stand.

// motion: of every person, as trajectories.h reads them.
void InspectCrowd(const PointMotion& motion, Inspection* found);

// What a manifest lists, and which of it can be read.

// Adds facts about the manifest at inspection->path, and a warning for every recording that cannot
// be read and everything unusual about the others.
MaybeError InspectManifest(Inspection* inspection);

}  // namespace pushid
