// models: the linear forecast: ridge regression from the last pose and the last displacements to
// all future poses at once. What any network has to beat, and a good partner in a blend.
//
//   features: last pose, then the last 9 displacements, newest first; m
//   targets:  future poses minus the last one
//   minimum over W of |Y - W X|^2 + penalty |W|^2, features and targets centred, intercept free
#pragma once

#include <vector>

#include "models/particles.h"

namespace pushid {

inline constexpr int kRidgeDisplacements = 9;

struct RidgeForecast {
  Eigen::MatrixXf weights;  // coordinates x frames, by features
  Eigen::VectorXf bias;

  // As many frames as it was fitted for; observed: at least ten frames.
  Trajectories Forecast(const Trajectories& observed) const;
};

// Sums over windows, so that no table of all of them stands in memory.
class RidgeFit {
 public:
  // Every start of a window of `observed` and `frames` frames in the motion.
  void Add(const Trajectories& motion, int observed, int frames);
  // penalty: m^2.
  RidgeForecast Solve(double penalty) const;

 private:
  Eigen::MatrixXd features_squared_, targets_by_features_;
  Eigen::VectorXd feature_sum_, target_sum_;
  double count_ = 0.0;
};

}  // namespace pushid
