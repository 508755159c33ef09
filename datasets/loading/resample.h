// datasets: recordings at another frame rate.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "datasets/manifest/recording.h"

namespace pushid {

// The frames of a track of `frames` frames that fit between its first and last at the other rate.
int ResampledFrames(int frames, double from_hz, double to_hz);

// The track at to_hz: cubic through the four nearest frames (Lagrange), the first frame as it is.
// Nothing is low-passed: that comes first where the rate goes down.
std::vector<Eigen::Vector3d> ResampleTrack(const std::vector<Eigen::Vector3d>& track,
                                           double from_hz, double to_hz);

// 1 where all frames that a new one leans on count, else the least of their weights.
std::vector<double> ResampleWeights(const std::vector<double>& weight, double from_hz,
                                    double to_hz);

// Rows are means over their frame, and so are the new ones: the impulse stays.
Push ResamplePush(const Push& push, double from_hz, double to_hz);

}  // namespace pushid
