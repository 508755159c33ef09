// models: smoothing and differentiating a sampled signal by local polynomials.
//
// Savitzky & Golay, Analytical Chemistry 36 (1964): a cubic is fitted to the 2 k + 1 samples around
// each one; near the ends the window keeps its length and the polynomial is read off centre.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace pushid {

struct SmoothedSample {
  Eigen::Vector4d value, rate, acceleration;
};

// window: odd, at least 5; shortened (to the largest odd number) where the signal is shorter.
// A signal of fewer than 5 samples is returned as it is, with zero derivatives.
std::vector<SmoothedSample> SavitzkyGolay(const std::vector<Eigen::Vector4d>& samples, int window,
                                          double dt);

}  // namespace pushid
