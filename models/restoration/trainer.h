// models: the interface of trainings, whose implementations (*_torch.cc) alone need LibTorch, and
// the trainings of restorations.
//
//   const auto trainer = MakeRegressionTrainer(training, validation, options);
//   while (!trainer->Done()) Show(trainer->RunRound());
//   Use(trainer->Network());
//
// With one thread, a training with the same seed repeats to the bit.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "models/restoration/cvae_restoration.h"
#include "models/restoration/dense_network.h"

namespace pushid {

// Options of every training, from which those of each kind derive.
struct TrainerOptions {
  uint64_t seed = 1;
  int num_threads = 1;
};

inline constexpr int kStepsOfRound = 50;  // in trainings without epochs

// A point of the training curve, after a round: an epoch, or some steps.
struct TrainingPoint {
  int epoch = 0;
  double training_loss = 0.0, validation_loss = 0.0;
  std::string stage{};  // empty: the training has one stage
};

using TrainingProgress = std::function<void(const TrainingPoint& point, double done)>;

class Trainer {
 public:
  virtual ~Trainer() = default;
  virtual bool Done() const = 0;
  virtual TrainingPoint RunRound() = 0;
  virtual double ShareDone() const = 0;  // of all steps, 0 .. 1
};

template <typename Trained>
class TrainerOf : public Trainer {
 public:
  virtual Trained Network() const = 0;
};

// Training of a dense network.
//
// Loss: mean absolute error of the outputs, weighted by sample. AdamW with a one-cycle learning
// rate (rising over the first 30 % of the steps, then falling to zero, both by cosines), dropout
// between layers, noise on the scaled inputs. A round is an epoch; Network() has the weights of the
// epoch with the least validation loss; training ends after `patience` epochs without a better one.

struct RegressionSamples {
  Eigen::MatrixXf inputs;   // scaled; a column per sample
  Eigen::MatrixXf targets;  // a column per sample
  Eigen::VectorXf weights;  // of the samples in the loss
};

struct RegressionOptions : TrainerOptions {
  int hidden = 256, hidden_layers = 2;
  double dropout = 0.2;
  double input_noise = 0.1;  // standard deviation, on scaled inputs
  double learning_rate = 2e-3;
  double weight_decay = 1e-2;
  int epochs = 40;
  int batch = 256;
  int patience = 15;  // epochs without a better validation loss
};

std::unique_ptr<TrainerOf<DenseNetwork>> MakeRegressionTrainer(const RegressionSamples& training,
                                                               const RegressionSamples& validation,
                                                               const RegressionOptions& options);

// Training of LDP's chain.
//
// Up to four stages (those of the layout), in this order: the lower autoencoder, its sampler, the
// upper autoencoder (on lower positions predicted by the finished lower chain), its sampler. A step
// takes one frame of 64 rollouts. The first 14 % of a stage's steps start from true frames; over
// the next 14 % a rising share, and then all, start from the network's own output, without
// gradients through earlier frames.
//   autoencoder: mean square error of the scaled frame + 0.005 KL to a standard normal, mean
//                over the latent variable
//   sampler:     squared difference from the encoder's Gaussian: published (Eq. 7)
//                |mu - mu_e|^2 + |sigma - sigma_e|^2; own: that of mean and log-variance, mean over
//                the latent variable; for the lower body also the foot-skate error of the output
//                (cvae_module_torch.h)
// Training `published`: Adam, a rate that falls linearly from 1e-4 to 1e-7 for autoencoders and is
// 1e-4 for samplers, whose output is decoded from a drawn z. `own` (default): AdamW with one cycle
// up to 1e-3, and z is the sampler's mean. The weight of the foot skate is not published. Source:
// Yue et al., CVPR 2024; autoencoders as in Ling et al., Character controllers using motion VAEs,
// SIGGRAPH 2020. A round is a few hundred steps. The weights of the round with the least held-out
// loss are kept, among the rounds of the second half of a stage.

// One person's motion; columns are frames, scaled.
struct CvaeSequence {
  BodyFrames body;
  Eigen::MatrixXf pendulum;
};

enum class CvaeTraining { kOwn, kPublished };
constexpr EnumNames<CvaeTraining, 2> Names(CvaeTraining) {
  return {{{"own", CvaeTraining::kOwn}, {"published", CvaeTraining::kPublished}}};
}

struct CvaeOptions : TrainerOptions {
  CvaeTraining training = CvaeTraining::kOwn;
  std::array<int, 4> steps = {12000, 8000, 12000, 8000};  // of the stages
  int rollout = 8, sampler_rollout = 16;                  // frames
  int batch = 64;
  int round = 400;              // steps
  double learning_rate = 1e-3;  // the highest of the cycle (own)
  double kl_weight = 0.005;
  double skate_weight = 0.06;  // per cm a frame
};

inline constexpr const char* kCvaeStageNames[4] = {"lower autoencoder", "lower sampler",
                                                   "upper autoencoder", "upper sampler"};

class CvaeTrainer : public TrainerOf<CvaeWeights> {
 public:
  // scalings: the layout and the scales, which become part of Network(). The held-out loss is the
  // mean error of the joint positions, m, of whole sequences predicted from their first frame, with
  // the encoder's z in stages of autoencoders and the sampler's mean in those of samplers.
  static std::unique_ptr<CvaeTrainer> Make(const std::vector<CvaeSequence>& training,
                                           const std::vector<CvaeSequence>& held,
                                           const CvaeWeights& scalings, const CvaeOptions& options);

  // Numbers of weights of the stages: 865536, 136960, 1097904, 159232; 0 for absent stages.
  virtual std::array<int64_t, 4> NumParameters() const = 0;
};

}  // namespace pushid
