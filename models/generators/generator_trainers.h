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
// The drift is trained first, on windows of observed and forecast frames whose own output is fed
// back; the loss is the mean joint distance, with weight 1/t for frame t. Then the noise is trained
// alone with a fixed drift, by the Gaussian likelihood of the true displacements, and finally its
// correlations are computed. The input pose is jittered, one draw per window and coordinate: there
// are few different poses, and displacements generalize better. Adam with a warm-up, a cosine decay
// of the rate to zero and clipped gradients.
//
// SDE's Eq. 6 trains drift and noise, f and g, together on the observed displacements; `together`
// does so in every step, in addition to the losses of the forecast. One draw w_1:K serves both:
// Eq. 6 uses it for frames 2 .. K, and g maps it into the input of the forecast (noisy_input of
// ParticleStructure), so that the losses of the forecast reach g as well.

// The loss of a transition. likelihood: -log N(p; f, g g^T) with its determinant. drawn: Eq. 6 as
// printed, |p - f - g w|^2 with w ~ N(0, 1) drawn, whose minimum is g = 0.
enum class NoiseLoss { kLikelihood, kDrawn };

struct LearntParticles {
  int group = 0;  // an action; drawn in proportion to the square root of its number of windows
  Trajectories motion;
};

struct ParticleTrainingOptions : TrainerOptions {
  ParticleStructure structure;
  int observed = 25, predicted = 25;  // frames of a window
  bool even_frames = false;           // equal weights in the loss; otherwise 1/t for frame t
  int steps = 1200, noise_steps = 300;
  int batch = 64;
  int warm_up = 100;
  double learning_rate = 1e-3;
  bool constant_rate = false;  // no warm-up, no cosine
  double clip = 1.0;           // largest norm of the gradient
  double jitter = 0.7;         // of the input pose, in units of pose_spread
  double mirrored = 0.5;       // share of windows
  // Weights of the losses.
  double distance = 1.0;  // mean joint distance
  double squared = 0.0;   // squared distances (SDE's Eq. 10)
  double bones = 0.0;     // bone lengths (Eq. 11)
  double critic = 0.0;    // a Wasserstein critic with gradient penalty (Eq. 12)
  double changes = 0.0;   // distance of the displacements from frame to frame (siMLPe)
  NoiseLoss noise_loss = NoiseLoss::kLikelihood;
  bool together = false;      // Eq. 6 trains f and g; needs noisy_input, and noise_steps is unused
  double transitions = 0.01;  // weight of Eq. 6 with `together`
};

inline constexpr int kFirstNoiseStep =
    10;  // the loss of the noise leaves out earlier displacements
inline constexpr int kFirstTransition = 1;  // with `together`: t = 2 .. K of Eq. 6

// A point of the curve is the mean loss of a round of steps, and the loss of the held windows
// (always the same, without jitter) after it.
class ParticleTrainer : public TrainerOf<ParticleNetwork> {
 public:
  static std::unique_ptr<ParticleTrainer> Make(const ParticleLayout& layout,
                                               const std::vector<LearntParticles>& learnt,
                                               const std::vector<LearntParticles>& held,
                                               const ParticleTrainingOptions& options);
  // LibTorch's forecast without noise, which tests compare with ParticleRollout.
  virtual Trajectories Forecast(const ObservedMotion& person, int frames) const = 0;
};

// Training of siMLPe, on the windows of particles and with two of their losses: the mean joint
// distance, all frames weighing the same, and that of the displacements. AdamW. The paper's 35,000
// steps of 256 windows and 48 blocks are reduced to one minute of training, and the rate follows a
// cosine instead of steps.

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
  // LibTorch's forecast, which tests compare with SimlpeNetwork.
  virtual Trajectories Forecast(const Trajectories& seen) const = 0;
};

// Training of the diffusion network.
//
// A step draws groups, mirrors some of them, turns and scales each a little, shows none or some of
// the first frames, adds noise of a random time t, and takes the loss of the estimate of x_0:
//
//   mean of |x - x_0| + 2 |joint - joint_0| (m) + 2 |change of joint - change of joint_0| (m)
//
// (SDM's Eq. 4 is the first term alone; the weights of the others are options). Observed frames
// have a smaller weight, and frames after a recording's end none. Some groups get bystanders, who
// stand far from all others and do not move: from groups alone the network cannot learn that a push
// does not reach everybody. AdamW with a warm-up, a cosine decay of the rate to a fiftieth and
// clipped gradients; the trained network has the exponential moving average of the weights.

using ObservedGroup = std::vector<ObservedMotion>;  // all frames of all people

struct DiffusionTrainingOptions : TrainerOptions {
  DiffusionStructure structure;
  int steps = 3000;
  int groups = 4;         // per step; eight in half as many steps learn less in the same time
  int people_alone = 24;  // instead of groups in every fifth step, where single people are recorded
  int warm_up = 100;      // steps
  double learning_rate = 2e-3;
  double weight_decay = 0.01;
  double clip = 1.0;         // largest norm of the gradient
  double averaging = 0.998;  // of the weights, from step to step
  double dropout = 0.1;      // of the statics, and of the input of the middle block
  // Weights of the second and third term of the loss; both need MotionFrame::kGroup.
  double joint_weight = 2.0, difference_weight = 2.0;
  double observed_weight = 0.1;  // of observed frames, in all terms
  double bystanders = 0.3;       // share of groups that get one or two bystanders
  double mirrored = 0.5;         // share of groups
  double turn = 0.12;            // rad, largest
  double size = 0.05;            // share, largest
  double dt = 1.0 / 60.0;        // s
};

// The loss of the held groups always uses the same noise; Network() has the averaged weights.
class DiffusionTrainer : public TrainerOf<DiffusionNetwork> {
 public:
  static std::unique_ptr<DiffusionTrainer> Make(const std::vector<ObservedGroup>& learnt,
                                                const std::vector<ObservedGroup>& held,
                                                const DiffusionTrainingOptions& options);
  // LibTorch's estimate from this noisy motion, which tests compare with GroupDenoiser.
  virtual Eigen::MatrixXf Estimate(const GroupFeatures& features, const Eigen::MatrixXf& noisy,
                                   double t) const = 0;
};

}  // namespace pushid
