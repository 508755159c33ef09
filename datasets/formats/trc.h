// datasets: TRC files (OpenSim, Motion Analysis): trajectories of markers as tab-separated text.
//
//   PathFileType  4  (X/Y/Z)  walk.trc
//   DataRate  CameraRate  NumFrames  NumMarkers  Units  OrigDataRate  OrigDataStartFrame  ...
//   100  100  580  2  mm  100  1  580
//   Frame#  Time  LASI      RASI
//                 X1 Y1 Z1  X2 Y2 Z2
//   1  0.00  ...
//
// Markers whose three cells are empty or NaN are not seen; at the end of a row their tabs may be
// left out.
#pragma once

#include "datasets/formats/point_motion.h"

namespace pushid {

// Errors name the line: a head that is none, more or fewer markers than announced, a row with other
// than its numbers, a marker with one or two of its three, a last row that is cut, wrong frame
// count.
Result<PointMotion> ReadTrc(const std::string& path, const PointReadOptions& options = {});

}  // namespace pushid
