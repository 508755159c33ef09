// datasets: ground that moves, from markers on it.
#pragma once

#include "datasets/loading/laboratory_record.h"

namespace pushid {

// The ground of the markers that the entry names, in the first person's file: the rigid motion of
// what is under that person. Short gaps are filled, with a warning; longer ones are Errors, which
// are thrown, and so are markers on a line or whose distances change (kRigidMarkers).
GroundTracks GroundOfMarkers(const ManifestRecording& entry, const Recording& recording,
                             const GroundReading& reading, Warnings* warnings);

}  // namespace pushid
