// ident: one forecast to look at: what was recorded, the forecast, and sampled futures as a fan.
#pragma once

#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/formats/bvh.h"
#include "ident/bodies/animation.h"
#include "models/generators/motion_generator.h"

namespace pushid {

struct ForecastScene {
  std::string title;
  double dt = 0.04;  // s
  ParticleLayout layout;
  Trajectories observed;
  Trajectories recorded;  // what came after; empty where it is not known
  Trajectories forecast;
  std::vector<SampledFuture> futures;

  int num_observed() const { return static_cast<int>(observed.cols()); }
  int num_frames() const { return num_observed() + static_cast<int>(forecast.cols()); }
};

// Every joint has position channels, which replace its offset: positions are exact, and rotations
// stay zero. Particles on fixed points hang on a root at the origin. Millimetres, the data's axes.
BvhMotion ToBvh(const Trajectories& motion, const ParticleLayout& layout, double dt);

// .bvh: observed frames and the forecast; with futures each of them in a file of its own beside it
// ("out_future_1.bvh"). .csv: frame,time_s,source,future,joint,x_m,y_m,z_m with source observed,
// recorded, forecast or future. Returns the files' names. Errors: another ending.
Result<std::vector<std::string>> WritePoses(const std::string& path, const ForecastScene& scene);
// Errors: an ending that is none of these.
MaybeError CheckPosesPath(const std::string& flag, const std::string& path);

// The scene as bodies are shown: recorded grey, the forecast and up to 20 of the futures in a
// colour each; the lowest point stands on the ground.
Animation ToAnimation(const ForecastScene& scene);

}  // namespace pushid
