// datasets: gaps, filter and frame rate of tracks.
#include <algorithm>
#include <cmath>

#include "datasets/files/number_text.h"
#include "datasets/loading/motion_preparation.h"
#include "datasets/sensors/sensor_choice.h"

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

namespace {

constexpr double kManyInterpolated = 0.1;  // of the frames that count

bool Many(int interpolated, int counting) {
  return interpolated > kManyInterpolated * static_cast<double>(counting);
}

}  // namespace

FilledTracks FillTracks(int max_gap, const std::vector<std::vector<Vector3d>*>& tracks) {
  FilledTracks filled;
  const size_t frames = tracks.empty() ? 0 : tracks[0]->size();
  std::vector<bool> seen(frames, true);
  filled.weight.assign(frames, 1.0);
  for (std::vector<Vector3d>* track : tracks) {
    for (size_t t = 0; t < frames; ++t) {
      if (!(*track)[t].allFinite()) seen[t] = false;
    }
    filled.gaps += FillGaps(max_gap, track, &filled.weight).gaps;
  }
  int counting = 0;
  for (size_t t = 0; t < frames; ++t) {
    if (filled.weight[t] == 0.0) continue;
    ++counting;
    if (!seen[t]) ++filled.interpolated_frames;
  }
  filled.excluded_frames = static_cast<int>(frames) - counting;
  filled.many = Many(filled.interpolated_frames, counting);
  if (!filled.many) return filled;
  const double share = static_cast<double>(counting - filled.interpolated_frames) / counting;
  for (size_t t = 0; t < frames; ++t) {
    if (filled.weight[t] > 0.0 && !seen[t]) filled.weight[t] = share;
  }
  return filled;
}

std::string FilledTracks::Warning(double max_gap_s) const {
  if (gaps == 0) return "";
  const std::string frames = std::to_string(weight.size());
  std::string text = "has " + std::to_string(gaps) + " gap" + (gaps == 1 ? "" : "s") +
                     " in hip and ankles; those of up to " + Rounded(max_gap_s) +
                     " s are interpolated, " + std::to_string(excluded_frames) + " of " + frames +
                     " frames are left out";
  if (many) {
    text += "; " + std::to_string(interpolated_frames) +
            " of the others are interpolated, more than a tenth: these count "
            "less; fill the gaps from other markers, or leave the recording out";
  }
  return text;
}

namespace {

double TwoPassCorrection() { return std::pow(std::sqrt(2.0) - 1.0, 0.25); }

// y_i = b (x_i + 2 x_{i-1} + x_{i-2}) - a1 y_{i-1} - a2 y_{i-2}
struct Biquad {
  double b, a1, a2;
};

// Of which two passes have lost 3 dB at the cut-off.
Biquad Butterworth(double cutoff_hz, double rate_hz) {
  const double k = std::tan(M_PI * cutoff_hz / rate_hz) / TwoPassCorrection();
  const double q = std::sqrt(2.0) * k;
  const double norm = 1.0 / (1.0 + q + k * k);
  return {k * k * norm, 2.0 * (k * k - 1.0) * norm, (1.0 - q + k * k) * norm};
}

// In place, from the steady state at the first value.
void Pass(const Biquad& filter, std::vector<Vector3d>* x) {
  Vector3d x1 = x->front(), x2 = x1, y1 = x1, y2 = x1;
  for (Vector3d& value : *x) {
    const Vector3d y = filter.b * (value + 2.0 * x1 + x2) - filter.a1 * y1 - filter.a2 * y2;
    x2 = x1;
    x1 = value;
    y2 = y1;
    y1 = y;
    value = y;
  }
}

}  // namespace

double HighestCutoff(double rate_hz) { return 0.499 * rate_hz; }

void LowPass(double cutoff_hz, double rate_hz, std::vector<Vector3d>* track) {
  const int frames = static_cast<int>(track->size());
  if (frames < 3) return;
  const Biquad filter = Butterworth(cutoff_hz, rate_hz);
  // Long enough for the filter to forget its start.
  const int wing = std::min(frames - 1, static_cast<int>(std::ceil(2.0 * rate_hz / cutoff_hz)));
  std::vector<Vector3d> x;
  x.reserve(frames + 2 * wing);
  const Vector3d first = track->front(), last = track->back();
  for (int i = wing; i > 0; --i) x.push_back(2.0 * first - (*track)[i]);
  x.insert(x.end(), track->begin(), track->end());
  for (int i = 1; i <= wing; ++i) x.push_back(2.0 * last - (*track)[frames - 1 - i]);
  Pass(filter, &x);
  std::reverse(x.begin(), x.end());
  Pass(filter, &x);
  std::reverse(x.begin(), x.end());
  std::copy(x.begin() + wing, x.begin() + wing + frames, track->begin());
}

namespace {

using Position = Eigen::Vector3d;

constexpr double kRounding = 1e-9;  // of a frame

// Where new frame i lies on the old frames.
double OldFrame(int i, double from_hz, double to_hz) { return i * from_hz / to_hz; }

}  // namespace

int ResampledFrames(int frames, double from_hz, double to_hz) {
  return static_cast<int>(std::floor((frames - 1) * to_hz / from_hz + kRounding)) + 1;
}

std::vector<Position> ResampleTrack(const std::vector<Position>& track, double from_hz,
                                    double to_hz) {
  std::vector<Position> result;
  for (int i = 0; i < ResampledFrames(static_cast<int>(track.size()), from_hz, to_hz); ++i) {
    result.push_back(ValueBetween(track, OldFrame(i, from_hz, to_hz)));
  }
  return result;
}

std::vector<double> ResampleWeights(const std::vector<double>& weight, double from_hz,
                                    double to_hz) {
  const int frames = static_cast<int>(weight.size());
  std::vector<double> result;
  for (int i = 0; i < ResampledFrames(frames, from_hz, to_hz); ++i) {
    const double at = OldFrame(i, from_hz, to_hz);
    const int before = std::clamp(static_cast<int>(std::floor(at + kRounding)), 0, frames - 1);
    const int after = std::clamp(static_cast<int>(std::ceil(at - kRounding)), 0, frames - 1);
    result.push_back(std::min(weight[before], weight[after]));
  }
  return result;
}

Push ResamplePush(const Push& push, double from_hz, double to_hz) {
  Push result = push;
  result.force.clear();
  // A row is the mean over half a frame before and after its own; what is before the first new
  // row's goes to that row.
  const auto new_frame = [&](double old_edge) { return (old_edge - 0.5) * to_hz / from_hz + 0.5; };
  const auto old_edge = [&](int new_row) { return (new_row - 0.5) * from_hz / to_hz + 0.5; };
  const int first = static_cast<int>(std::floor(new_frame(push.start_frame) + kRounding));
  const int end = static_cast<int>(std::ceil(new_frame(push.EndFrame()) - kRounding));
  result.start_frame = std::max(0, first);
  for (int i = result.start_frame; i < end; ++i) {
    Eigen::Vector4d impulse = Eigen::Vector4d::Zero();  // over the new row, in old frames
    const double from = i == 0 ? std::min<double>(old_edge(0), push.start_frame) : old_edge(i);
    const double to = old_edge(i + 1);
    for (int row = 0; row < static_cast<int>(push.force.size()); ++row) {
      const double left = std::max<double>(from, row + push.start_frame);
      const double right = std::min<double>(to, row + push.start_frame + 1.0);
      if (right > left) impulse += (right - left) * push.force[row];
    }
    result.force.push_back(impulse * to_hz / from_hz);
  }
  return result;
}

}  // namespace pushid
