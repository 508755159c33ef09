// datasets: zero-phase low-pass filtering, as gait laboratories do it: a second-order Butterworth
// filter over the track and back again, which cancels its delay and makes it of fourth order.
//
// Bilinear transform with pre-warping; `cutoff` is where the two passes together have lost 3 dB, so
// the single pass is designed for cutoff / (sqrt(2) - 1)^(1/4) (Winter's correction). Before both
// passes the track is continued at either end by its point reflection, and the filter starts from
// its steady state, so that ends do not ring.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace pushid {

// cutoff in (0, rate / 2) after the correction, see HighestCutoff; leaves tracks of fewer than
// three frames alone. Every position must be finite.
void LowPass(double cutoff_hz, double rate_hz, std::vector<Eigen::Vector3d>* track);

// The highest cut-off that LowPass can make at this rate, Hz.
double HighestCutoff(double rate_hz);

}  // namespace pushid
