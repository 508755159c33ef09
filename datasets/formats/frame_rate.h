// datasets: frame rates that files and manifests may give.
#pragma once

#include <string>

namespace pushid {

constexpr double kMinFramesPerSecond = 1.0;
constexpr double kMaxFramesPerSecond = 10000.0;

// "is 0; accepted are 1 to 10000 frames per second", or "" where the rate is accepted.
std::string FrameRateProblem(double fps);

// What a file's rate most likely is: the next whole number within 0.1 %, for files round their
// frame time (0.016667 s is meant to be 1/60 s). Rates of video, which lie 0.1 % below a whole
// number (60/1.001), and all others stay as they are.
double WholeFrameRate(double fps);

}  // namespace pushid
