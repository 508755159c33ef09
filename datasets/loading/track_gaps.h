// datasets: gaps in tracks: frames in which a marker was not seen.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace pushid {

struct GapCount {
  int gaps = 0;
  int filled_frames = 0;    // in gaps that are short enough
  int excluded_frames = 0;  // in longer ones, and before the first and after the last frame seen
  int longest = 0;          // frames
};

// Fills every gap (positions that are not finite) of `track`: gaps of up to max_gap frames inside
// by a cubic through the two frames on either side (Hermite, slopes by differences); longer ones by
// a straight line, and the ends by the nearest position, where `weight` (one per frame) becomes 0.
// A track that was never seen stays as it is, with all weights 0.
GapCount FillGaps(int max_gap, std::vector<Eigen::Vector3d>* track, std::vector<double>* weight);

}  // namespace pushid
