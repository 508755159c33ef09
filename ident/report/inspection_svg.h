// ident: a picture of what pushid-inspect found: the path of the hip, steps, when each point was
// seen, forces.
#pragma once

#include <string>

#include "datasets/inspection/inspection.h"

namespace pushid {

// SVG text; a panel for each of these that was found: the hip's three coordinates less those of its
// first frame, with the onset marked; when each foot is off the ground; a bar per point with its
// gaps (at most 60 points, those with gaps first); forces.
std::string InspectionSvg(const Inspection& inspection);

}  // namespace pushid
