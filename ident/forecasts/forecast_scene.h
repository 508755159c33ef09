// ident: one forecast for display: recorded motion, the forecast, and sampled futures.
#pragma once

#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "ident/bodies/animation.h"
#include "models/generators/motion_generator.h"

namespace pushid {

struct ForecastScene {
  std::string title;
  double dt = 0.04;  // s
  ParticleLayout layout;
  Trajectories observed;
  Trajectories recorded;  // the true future; empty if unknown
  Trajectories forecast;
  std::vector<SampledFuture> futures;

  int num_observed() const { return static_cast<int>(observed.cols()); }
  int num_frames() const { return num_observed() + static_cast<int>(forecast.cols()); }
};

// Columns: frame,time_s,source,future,joint,x_m,y_m,z_m with source observed, recorded, forecast or
// future.
MaybeError WriteForecastCsv(const std::string& path, const ForecastScene& scene);

// The scene for a page: recorded motion in grey, the forecast and up to 20 futures in a colour
// each; the lowest point of all stands on the ground.
Animation ToAnimation(const ForecastScene& scene);

}  // namespace pushid
