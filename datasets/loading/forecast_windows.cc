// datasets: windows of clips.
#include "datasets/loading/forecast_windows.h"

#include <algorithm>
#include <random>

namespace pushid {
namespace {

constexpr int kWindow = kObservedFrames + kForecastFrames;
constexpr int kTestWindows = 8, kTestSeed = 1234567890;
constexpr int kManyWindows = 1000, kWideStride = 8, kNarrowStride = 2;

ForecastWindow WindowAt(const MocapClip& clip, const Trajectories& motion, int start) {
  return {clip.action, motion.middleCols(start, kObservedFrames),
          motion.middleCols(start + kObservedFrames, kForecastFrames)};
}

}  // namespace

Trajectories EverySecond(const Trajectories& motion, int phase) {
  Trajectories half(motion.rows(), (motion.cols() - phase + 1) / 2);
  for (Eigen::Index t = 0; t < half.cols(); ++t) half.col(t) = motion.col(2 * t + phase);
  return half;
}

std::vector<int> TestWindowStarts(int frames) {
  const int largest = frames - kObservedFrames - kWindow - 1;
  std::vector<int> starts;
  if (largest < 0) return starts;
  uint32_t mask = 0;
  while (mask < static_cast<uint32_t>(largest)) mask = 2 * mask + 1;
  std::mt19937 random(kTestSeed);
  while (starts.size() < kTestWindows) {
    const uint32_t word = static_cast<uint32_t>(random()) & mask;
    if (word <= static_cast<uint32_t>(largest)) starts.push_back(static_cast<int>(word));
  }
  return starts;
}

bool IsValidationClip(const MocapFolder& mocap, const MocapClip& clip) {
  if (clip.is_test) return false;
  const MocapClip* last = nullptr;
  for (const MocapClip& other : mocap.clips) {
    if (other.action == clip.action && !other.is_test) last = &other;
  }
  return last == &clip;
}

std::vector<ForecastWindow> MakeForecastWindows(const MocapFolder& mocap, ForecastProtocol protocol,
                                                int stride) {
  const bool has_test = std::any_of(mocap.clips.begin(), mocap.clips.end(),
                                    [](const MocapClip& clip) { return clip.is_test; });
  std::vector<ForecastWindow> windows;
  for (const MocapClip& clip : mocap.clips) {
    const Trajectories motion = EverySecond(clip.motion, 0);
    const int frames = static_cast<int>(motion.cols());
    if (protocol == ForecastProtocol::kTest) {
      if (clip.is_test != has_test) continue;
      for (int start : TestWindowStarts(frames)) {
        windows.push_back(WindowAt(clip, motion, start + kObservedFrames));
      }
      continue;
    }
    if (protocol == ForecastProtocol::kValidation && !IsValidationClip(mocap, clip)) continue;
    const int starts = frames - kWindow + 1;
    const int step = stride > 0 ? stride : starts > kManyWindows ? kWideStride : kNarrowStride;
    for (int start = 0; start < starts; start += step) {
      windows.push_back(WindowAt(clip, motion, start));
    }
  }
  return windows;
}

std::vector<LearntMotion> LearntMotions(const MocapFolder& mocap, bool with_validation) {
  std::vector<LearntMotion> motions;
  for (const MocapClip& clip : mocap.clips) {
    if (clip.is_test || (!with_validation && IsValidationClip(mocap, clip))) continue;
    for (int phase : {0, 1}) {
      motions.push_back({clip.action, EverySecond(clip.motion, phase), phase});
    }
  }
  return motions;
}

}  // namespace pushid
