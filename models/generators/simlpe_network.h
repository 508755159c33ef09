// models: siMLPe, to blend particles with and to compare with: a perceptron over the cosine
// coefficients of what was observed, without recurrence, displacements or noise (Guo et al., "Back
// to MLP: A Simple Baseline for Human Motion Prediction", WACV 2023).
//
//   Z = D (S - pose_mean) / pose_spread        D: the orthonormal DCT-II over the T frames observed
//   Y = Z W_in + b_in                          all coordinates, each coefficient alone
//   Y <- Y + norm(A_i Y + a_i),  i < blocks    all coefficients, each coordinate alone
//   S_{T+u} = S_T + pose_spread [D' (Y W_out + b_out)]_u,  u = 1 .. T
//
// norm: layer norm over the coordinates of each coefficient, the only nonlinearity. Apart from the
// paper poses are scaled, and with 25 frames observed instead of 50 forecasts of the same length
// fill all of T. Longer forecasts continue its own.
#pragma once

#include "models/generators/motion_generator.h"
#include "models/restoration/dense_network.h"

namespace pushid {

struct SimlpeBlock {
  DenseLayer mix;                // A_i, a_i: over coefficients
  Eigen::VectorXf scale, shift;  // of the norm, by coordinate
};

struct SimlpeNetwork {
  Eigen::VectorXf pose_mean, pose_spread;  // by coordinate; m
  DenseLayer input, output;                // over coordinates
  std::vector<SimlpeBlock> blocks;

  int observed() const { return static_cast<int>(blocks.front().mix.bias.size()); }
  // The last T frames of `seen` are read.
  Trajectories Forecast(const Trajectories& seen, int frames) const;
};

inline constexpr float kNormSmooth = 1e-5f;  // added to the variance

void AddTensors(const std::string& name, const SimlpeNetwork& network, TensorList* tensors);
SimlpeNetwork TakeSimlpe(const std::string& name, int observed, int coordinates, int blocks,
                         TensorReader* reader);

// The mean of several seeds.
Trajectories MeanForecast(const std::vector<SimlpeNetwork>& members, const Trajectories& seen,
                          int frames);

// Networks of several seeds averaged. It has no noise: there is nothing to sample.
class SimlpeGenerator : public MotionGenerator {
 public:
  SimlpeGenerator(ParticleLayout layout, std::vector<SimlpeNetwork> members)
      : layout_(std::move(layout)), members_(std::move(members)) {}

  const ParticleLayout& layout() const override { return layout_; }
  std::vector<Trajectories> Forecast(const std::vector<ObservedMotion>& people,
                                     int frames) const override;
  // `count` times the forecast.
  std::vector<std::vector<SampledFuture>> Sample(const std::vector<ObservedMotion>& people,
                                                 int frames, int count,
                                                 const NormalSource& normal) const override;

 private:
  ParticleLayout layout_;
  std::vector<SimlpeNetwork> members_;
};

}  // namespace pushid
