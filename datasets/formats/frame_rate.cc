// datasets: frame rates, checked and rounded.
#include "datasets/formats/frame_rate.h"

#include <cmath>

#include "datasets/files/number_text.h"

namespace pushid {

std::string FrameRateProblem(double fps) {
  if (fps >= kMinFramesPerSecond && fps <= kMaxFramesPerSecond) return "";
  return "is " + Rounded(fps) + "; accepted are " + Rounded(kMinFramesPerSecond) + " to " +
         Rounded(kMaxFramesPerSecond) + " frames per second";
}

double WholeFrameRate(double fps) {
  constexpr double kRounding = 1e-3;
  constexpr double kVideo = 1.0 / 1.001;
  const double whole = std::round(fps);
  if (!(whole > 0.0) || std::fabs(fps / whole - 1.0) > kRounding) return fps;
  const bool is_video = std::fabs(fps - kVideo * whole) < std::fabs(fps - whole);
  return is_video ? fps : whole;
}

}  // namespace pushid
