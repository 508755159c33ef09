// models: training of particles.
//
// The drift first: windows of observed and forecast frames, own output fed back in the forecast,
// mean distance of joints with frame t weighing 1/t. Then the noise, with the drift as it is: the
// Gaussian likelihood of the true displacements, and at last its correlations. What the network is
// told of the pose is jittered, one draw a window and coordinate: poses are few, and displacements
// say more. Adam, a warm-up, the rate down to nothing by a cosine, gradients clipped.
#pragma once

#include <string>
#include <vector>

#include "models/generators/particle_network.h"
#include "models/restoration/trainer.h"

namespace pushid {

// How the noise is learned. likelihood: -log N(p; f, g^2) with its determinant, the meaning of
// SDE's Eq. 6. squared: the squared error of the sampled transition, |p - f|^2 + g^2 in the mean,
// what is left of it without the determinant; its minimum is g = 0.
enum class NoiseLoss { kLikelihood, kSquared };
constexpr EnumNames<NoiseLoss, 2> Names(NoiseLoss) {
  return {{{"likelihood", NoiseLoss::kLikelihood}, {"squared", NoiseLoss::kSquared}}};
}

struct LearntParticles {
  int group = 0;  // an action; groups are drawn by the root of their number of windows
  Trajectories motion;
  Eigen::MatrixXf controls = {};
};

struct ParticleTrainingOptions : TrainerOptions {
  ParticleStructure structure;
  int observed = 25, predicted = 25;  // frames of a window
  bool from_start = false;   // windows begin where the motion does, and may be longer than it
  bool even_frames = false;  // of the loss; otherwise frame t weighs 1/t
  int steps = 1200, noise_steps = 300;
  int batch = 64;
  int warm_up = 100;
  double learning_rate = 1e-3;
  double clip = 1.0;      // largest norm of the gradient
  double jitter = 0.7;    // of the pose, in its spreads
  double mirrored = 0.5;  // share of windows
  double squared = 0.0;   // weight of squared distances (SDE's Eq. 10)
  double bones = 0.0;     // of bone lengths (Eq. 11)
  double critic = 0.0;    // of a Wasserstein critic with gradient penalty (Eq. 12)
  NoiseLoss noise_loss = NoiseLoss::kLikelihood;
  std::vector<float> mirrored_controls;  // the sign of each control in the mirror
};

inline constexpr int kParticleRound = 50;   // steps of a point of the curve
inline constexpr int kFirstNoiseStep = 10;  // displacements before are not judged by the noise

class ParticleTrainer : public Trainer {
 public:
  ParticleTrainer(const ParticleLayout& layout, const std::vector<LearntParticles>& learnt,
                  const std::vector<LearntParticles>& held, const ParticleTrainingOptions& options);

  // Mean losses of some steps; of the held windows (fixed, not jittered) at the end.
  ParticleNetwork Network() const;
  // What LibTorch forecasts without noise; for comparison with ParticleRollout.
  Trajectories Forecast(const ObservedMotion& person, int frames) const;

 private:
  struct Torch;
};

}  // namespace pushid
