// datasets: tracks of positions: their gaps, a low-pass filter, another frame rate.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "datasets/manifest/recording.h"

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

// Zero-phase low-pass filtering, as gait laboratories do it: a second-order Butterworth
// filter over the track and back again, which cancels its delay and makes it of fourth order.
//
// Bilinear transform with pre-warping; `cutoff` is where the two passes together have lost 3 dB, so
// the single pass is designed for cutoff / (sqrt(2) - 1)^(1/4) (Winter's correction). Before both
// passes the track is continued at either end by its point reflection, and the filter starts from
// its steady state, so that ends do not ring.

// cutoff in (0, rate / 2) after the correction, see HighestCutoff; leaves tracks of fewer than
// three frames alone. Every position must be finite.
void LowPass(double cutoff_hz, double rate_hz, std::vector<Eigen::Vector3d>* track);

// The highest cut-off that LowPass can make at this rate, Hz.
double HighestCutoff(double rate_hz);

// Recordings at another frame rate.

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
