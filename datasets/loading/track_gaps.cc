// datasets: gaps in tracks.
#include "datasets/loading/track_gaps.h"

#include <algorithm>

namespace pushid {
namespace {

using Eigen::Vector3d;

// Per frame, from the neighbour beyond where it was seen; otherwise that of the straight line.
Vector3d Slope(const std::vector<Vector3d>& track, int at, int beyond, const Vector3d& line) {
  const bool seen =
      beyond >= 0 && beyond < static_cast<int>(track.size()) && track[beyond].allFinite();
  return seen ? Vector3d((track[at] - track[beyond]) / (at - beyond)) : line;
}

// Between the seen frames `before` and `after`.
void FillInside(int before, int after, bool curved, std::vector<Vector3d>* track) {
  const Vector3d from = (*track)[before], to = (*track)[after];
  const double span = after - before;
  const Vector3d line = (to - from) / span;
  const Vector3d m0 = curved ? Slope(*track, before, before - 1, line) : line;
  const Vector3d m1 = curved ? Slope(*track, after, after + 1, line) : line;
  for (int i = before + 1; i < after; ++i) {
    const double s = (i - before) / span, r = 1.0 - s;
    (*track)[i] = r * r * (1.0 + 2.0 * s) * from + s * r * r * span * m0 +
                  s * s * (3.0 - 2.0 * s) * to - s * s * r * span * m1;
  }
}

}  // namespace

GapCount FillGaps(int max_gap, std::vector<Vector3d>* track, std::vector<double>* weight) {
  GapCount count;
  const int frames = static_cast<int>(track->size());
  for (int begin = 0; begin < frames;) {
    if ((*track)[begin].allFinite()) {
      ++begin;
      continue;
    }
    int end = begin;
    while (end < frames && !(*track)[end].allFinite()) ++end;
    const int length = end - begin;
    const bool inside = begin > 0 && end < frames;
    const bool fill = inside && length <= max_gap;
    ++count.gaps;
    count.longest = std::max(count.longest, length);
    (fill ? count.filled_frames : count.excluded_frames) += length;
    if (!fill) std::fill(weight->begin() + begin, weight->begin() + end, 0.0);
    if (inside) {
      FillInside(begin - 1, end, fill, track);
    } else if (length < frames) {
      const Vector3d nearest = begin > 0 ? (*track)[begin - 1] : (*track)[end];
      std::fill(track->begin() + begin, track->begin() + end, nearest);
    }
    begin = end;
  }
  return count;
}

}  // namespace pushid
