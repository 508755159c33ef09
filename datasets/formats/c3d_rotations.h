// datasets: the poses of segments in a C3D file (group ROTATION, as Theia3D and Visual3D write
// them).
//
// From the block ROTATION:DATA_START on stand, for every frame, ROTATION:RATIO times (once, where
// it is not said) ROTATION:USED poses of 17 floats each: a 4 x 4 matrix by columns, segment to
// world, whose last column is the segment's origin in POINT:UNITS, and its reliability, negative
// where the segment was not seen.
#pragma once

#include "datasets/formats/c3d.h"
#include "datasets/formats/c3d_bytes.h"

namespace pushid {

bool HasC3dRotations(const C3dFile& file);

// Adds the origins as points, by the names of ROTATION:LABELS without Theia3D's ending _4X4; of
// several poses in a frame the first. What is no rotation was not seen. Errors: poses that the file
// ends before.
MaybeError AddC3dRotations(const C3dBytes& bytes, C3dFile* file);

}  // namespace pushid
