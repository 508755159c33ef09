// ident: forecasts put together (stacking: Wolpert, Neural Networks 5, 1992; Breiman, Machine
// Learning 24, 1996).
//
// After s seconds, h seconds ahead, the forecast is the mean of all forecasters' hips with the
// weights
//   w_c = exp(z_c) / sum exp(z),   z_c = logits_c . [1, log(s / 0.35 s), log(h / 0.5 s)]
// of those that are available: non-negative, of sum one. With frame 0 alone it is physics.
//
// An error on one axis (along the push, across, upwards) has the scale
//   exp(coefficients . [1, log(h / 0.5 s), log((s + 0.05 s) / 0.35 s), log(v + 0.05 m/s)]),
// v the mean speed to which the forecast takes the hip, and over that scale the quantiles of what
// was found, alike on both sides: the middle of every distribution is the forecast itself.
#pragma once

#include <array>
#include <vector>

#include "datasets/files/random.h"
#include "ident/observed/first_frames.h"

namespace pushid {

using ForecastWeights = std::array<double, kNumForecasters>;

// [1, log(s / 0.35 s), log(h / 0.5 s)]
Eigen::Vector3d LogitFeatures(double seconds, double ahead);
// available: one at least. seconds: seen; ahead: from there.
ForecastWeights WeightsOf(const std::array<Eigen::Vector3d, kNumForecasters>& logits,
                          const std::array<bool, kNumForecasters>& available, double seconds,
                          double ahead);
std::array<bool, kNumForecasters> Available(const ForecastsOfAll& forecasts, double seconds,
                                            ForecastUse use);

// By frame ahead; empty where nobody is available.
std::vector<ForecastWeights> WeightsAhead(const ForecastStack& stack,
                                          const ForecastsOfAll& forecasts, double seconds,
                                          double dt, ForecastUse use = ForecastUse::kStack);
HipPaths Stacked(const std::vector<ForecastWeights>& weights, const ForecastsOfAll& forecasts);

// Of log scale, as above.
Eigen::Vector4d ScaleFeatures(double ahead, double seconds, double speed);

// Where hips will be.
class HipDistribution {
 public:
  // centre: the forecast, by person and frame ahead; from: where the hips were at the last frame
  // seen. axes: columns along the push, across, upwards.
  HipDistribution(const ForecastStack& stack, const Eigen::Matrix3d& axes, HipPaths centre,
                  const std::vector<Vector3<double>>& from, double seconds, double dt);

  int num_people() const { return static_cast<int>(centre_.size()); }
  int num_frames() const { return centre_.empty() ? 0 : static_cast<int>(centre_[0].size()); }

  // frame: 0 is the first that was not seen; axis: 0 x, 1 y, 2 z.
  double Cdf(int person, int frame, int axis, double value) const;
  double Quantile(int person, int frame, int axis, double share) const;
  // Continuous ranked probability score of one value (Gneiting and Raftery 2007), m.
  double Crps(int person, int frame, int axis, double value) const;
  // One future: how far from the middle each person goes on each axis, in scales. Frame by frame
  // draws are spread as the distribution says; a person who is far out stays so, as errors of
  // velocity do, which add up.
  HipPaths Draw(Random* random) const;

 private:
  double Scale(int person, int frame, int axis) const { return scale_[person][frame][axis]; }

  std::array<std::vector<double>, 3> quantiles_;  // on the world's axes
  HipPaths centre_, scale_;
};

}  // namespace pushid
