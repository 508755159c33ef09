// datasets: where a body's mass is, from its recorded segments.
//
// Masses, centres and radii of gyration of segments are the means of women and men in de Leva, J.
// Biomechanics 29, 1996, table 4. Of the 22 joints of a body (body_roles.h) all segments above the
// ankles are added up at frame 0, as they stand there. Where only shoulders are seen besides hip
// and ankles, legs are straight and head, arms and trunk are one segment whose centre is 0.6 of the
// way from hip to shoulders; where not even those are, the body is an average one
// (models/standing.h).
#pragma once

#include "datasets/manifest/recording.h"
#include "models/mass_distribution.h"

namespace pushid {

// person: its joints where they were asked for (LoadOptions::keep_all_joints).
MassDistribution MassesOf(const RecordedPerson& person);

// Whether the body is the average one, for want of joints.
bool IsAverage(const MassDistribution& masses);

}  // namespace pushid
