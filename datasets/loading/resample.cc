// datasets: recordings at another frame rate.
#include "datasets/loading/resample.h"

#include <algorithm>
#include <cmath>

namespace pushid {
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
  const int frames = static_cast<int>(track.size());
  const int nodes = std::min(4, frames);
  std::vector<Position> result;
  for (int i = 0; i < ResampledFrames(frames, from_hz, to_hz); ++i) {
    const double at = OldFrame(i, from_hz, to_hz);
    const int first = std::clamp(static_cast<int>(std::floor(at)) - 1, 0, frames - nodes);
    Position sum = Position::Zero();
    for (int j = 0; j < nodes; ++j) {
      double share = 1.0;
      for (int k = 0; k < nodes; ++k) {
        if (k != j) share *= (at - first - k) / (j - k);
      }
      sum += share * track[first + j];
    }
    result.push_back(sum);
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
  const double begin_s = push.start_frame / from_hz, end_s = push.EndFrame() / from_hz;
  result.start_frame = static_cast<int>(std::floor(begin_s * to_hz + kRounding));
  const int end = static_cast<int>(std::ceil(end_s * to_hz - kRounding));
  for (int i = result.start_frame; i < end; ++i) {
    Eigen::Vector4d impulse = Eigen::Vector4d::Zero();  // over the new frame, in old frames
    const double from = OldFrame(i, from_hz, to_hz), to = OldFrame(i + 1, from_hz, to_hz);
    for (int row = std::max(0, static_cast<int>(std::floor(from)) - push.start_frame);
         row < static_cast<int>(push.force.size()) && row + push.start_frame < to; ++row) {
      const double left = std::max<double>(from, row + push.start_frame);
      const double right = std::min<double>(to, row + push.start_frame + 1.0);
      if (right > left) impulse += (right - left) * push.force[row];
    }
    result.force.push_back(impulse / (to - from));
  }
  return result;
}

}  // namespace pushid
