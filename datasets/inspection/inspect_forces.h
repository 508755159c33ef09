// datasets: the forces in a file, for its inspection.
#pragma once

#include <string>
#include <vector>

#include "datasets/formats/c3d.h"
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

}  // namespace pushid
