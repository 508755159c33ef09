// models: training of generators, one trainer for each kind (*_trainer_torch.cc).
#pragma once

#include <memory>
#include <vector>

#include "models/generators/diffusion_generator.h"
#include "models/generators/particle_generator.h"
#include "models/restoration/trainer.h"

namespace pushid {

// Training of particles.
//
// The drift first: windows of observed and forecast frames, own output fed back in the forecast,
// mean distance of joints with frame t weighing 1/t. Then the noise alone, with the drift as it is:
// the Gaussian likelihood of the true displacements, and at last its correlations. What the network
// is told of the pose is jittered, one draw a window and coordinate: poses are few, and
// displacements say more. Adam, a warm-up, the rate down to nothing by a cosine, gradients clipped.

// SDE's Eq. 6 trains drift and noise, f and g, together on the observed displacements. `together`
// does that, in every step beside the losses of the forecast. One draw w_1:K serves both: Eq. 6 has
// it of frames 2 .. K, and g maps it into what the forecast is given (noisy_input of
// ParticleStructure), so that the losses of the forecast reach g as well.

// The charge of transitions. likelihood: -log N(p; f, g g^T) with its determinant. drawn: Eq. 6
// as it is printed, |p - f - g w|^2 with w ~ N(0, 1) drawn, whose minimum is g = 0.
enum class NoiseLoss { kLikelihood, kDrawn };

struct LearntParticles {
  int group = 0;  // an action; groups are drawn by the root of their number of windows
  Trajectories motion;
};

struct ParticleTrainingOptions : TrainerOptions {
  ParticleStructure structure;
  int observed = 25, predicted = 25;  // frames of a window
  bool even_frames = false;           // of the loss; otherwise frame t weighs 1/t
  int steps = 1200, noise_steps = 300;
  int batch = 64;
  int warm_up = 100;
  double learning_rate = 1e-3;
  bool constant_rate = false;  // no warm-up, no cosine
  double clip = 1.0;           // largest norm of the gradient
  double jitter = 0.7;         // of the pose, in its spreads
  double mirrored = 0.5;       // share of windows
  double distance = 1.0;       // weight of distances
  double squared = 0.0;        // of squared distances (SDE's Eq. 10)
  double bones = 0.0;          // of bone lengths (Eq. 11)
  double critic = 0.0;         // of a Wasserstein critic with gradient penalty (Eq. 12)
  double changes = 0.0;        // of the distance of displacements from frame to frame (siMLPe)
  NoiseLoss noise_loss = NoiseLoss::kLikelihood;
  bool together = false;      // Eq. 6 trains f and g, of noisy_input; there are no steps of noise
  double transitions = 0.01;  // weight of Eq. 6 where it trains both
};

inline constexpr int kFirstNoiseStep = 10;  // displacements before are not judged by the noise
inline constexpr int kFirstTransition = 1;  // of f and g trained together: t = 2 .. K of Eq. 6

// Points of the curve have mean losses of some steps, and that of the held windows (fixed, not
// jittered) after them.
class ParticleTrainer : public TrainerOf<ParticleNetwork> {
 public:
  static std::unique_ptr<ParticleTrainer> Make(const ParticleLayout& layout,
                                               const std::vector<LearntParticles>& learnt,
                                               const std::vector<LearntParticles>& held,
                                               const ParticleTrainingOptions& options);
  // LibTorch's forecast without noise; for comparison with ParticleRollout.
  virtual Trajectories Forecast(const ObservedMotion& person, int frames) const = 0;
};

// Training of siMLPe, on the windows of particles and by their losses: mean distance of joints, of
// every frame alike, and of their displacements. AdamW; the paper's 35,000 steps of 256 windows and
// 48 blocks are cut to what takes a minute, and the rate goes down by a cosine instead of a stair.

struct SimlpeTrainingOptions : ParticleTrainingOptions {
  SimlpeTrainingOptions() {
    steps = 1500;
    even_frames = true;
    jitter = 0.0;
    changes = 1.0;
  }
  int blocks = 24;
  double weight_decay = 1e-4;
};

class SimlpeTrainer : public TrainerOf<SimlpeNetwork> {
 public:
  static std::unique_ptr<SimlpeTrainer> Make(const ParticleLayout& layout,
                                             const std::vector<LearntParticles>& learnt,
                                             const std::vector<LearntParticles>& held,
                                             const SimlpeTrainingOptions& options);
  // LibTorch's forecast; for comparison with SimlpeNetwork.
  virtual Trajectories Forecast(const Trajectories& seen) const = 0;
};

// Training of the diffusion network.
//
// A step takes some groups, each in the mirror or not, a little turned, larger or smaller, shows
// some of the first frames or none, adds noise of a random time t, and charges the estimate of x_0:
//
//   |x - x_0| + 2 |joint - joint_0| in m + 2 |the same differences of frames|, in means
//
// (SDM's Eq. 4 is the first term alone; the weights of the others are options),
// where observed frames weigh less and those after the recording's end nothing. Into some groups
// people are put who stand far from all others and do nothing: from groups alone the network cannot
// know that a push does not reach everybody. AdamW, a warm-up, the rate down to a fiftieth by a
// cosine, gradients clipped; what is used is the exponential mean of the weights.

using ObservedGroup = std::vector<ObservedMotion>;  // all frames of everybody

struct DiffusionTrainingOptions : TrainerOptions {
  DiffusionStructure structure;
  int steps = 3000;
  int groups = 4;         // of a step; eight in half as many steps learn less in the same time
  int people_alone = 24;  // of every fifth step, where there are recordings of one person
  int warm_up = 100;      // steps
  double learning_rate = 2e-3;
  double weight_decay = 0.01;
  double clip = 1.0;         // largest norm of the gradient
  double averaging = 0.998;  // of the weights, from step to step
  double dropout = 0.1;      // of the statics, and of what the middle is given
  // Weights of the terms beside Eq. 4 of SDM; joints in m need the group's frame.
  double joint_weight = 2.0, difference_weight = 2.0;
  double observed_weight = 0.1;  // of observed frames, in all terms
  double bystanders = 0.3;       // share of groups that get one or two
  double mirrored = 0.5;         // share of groups
  double turn = 0.12;            // rad, largest
  double size = 0.05;            // share, largest
  double dt = 1.0 / 60.0;        // s
};

// Held groups are judged in the same noise always; Network() has the mean weights.
class DiffusionTrainer : public TrainerOf<DiffusionNetwork> {
 public:
  static std::unique_ptr<DiffusionTrainer> Make(const std::vector<ObservedGroup>& learnt,
                                                const std::vector<ObservedGroup>& held,
                                                const DiffusionTrainingOptions& options);
  // LibTorch's estimate from this noisy motion; for comparison with GroupDenoiser.
  virtual Eigen::MatrixXf Estimate(const GroupFeatures& features, const Eigen::MatrixXf& noisy,
                                   double t) const = 0;
};

}  // namespace pushid
