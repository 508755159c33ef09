// models: a training, with LibTorch behind it and nothing of LibTorch in front; and the trainings
// of restorations.
//
//   const auto trainer = MakeRegressionTrainer(training, validation, options);
//   while (!trainer->Done()) Show(trainer->RunRound());
//   Use(trainer->Network());
//
// With one thread a seed gives the same bits.
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

// Options of every training; those of a kind add to them.
struct TrainerOptions {
  uint64_t seed = 1;
  int num_threads = 1;
};

inline constexpr int kStepsOfRound = 50;  // where a round is not an epoch

// A point of the training curve: one round, which is an epoch or some steps.
struct TrainingPoint {
  int epoch = 0;
  double training_loss = 0.0, validation_loss = 0.0;
  std::string stage{};  // where a training has several
};

// done: share of all steps, 0 .. 1.
using TrainingProgress = std::function<void(const TrainingPoint& point, double done)>;

class Trainer {
 public:
  virtual ~Trainer() = default;
  virtual bool Done() const = 0;
  virtual TrainingPoint RunRound() = 0;
  virtual double ShareDone() const = 0;  // after a round; 0 .. 1
};

// A training of one kind of network, in a *_torch.cc.
template <typename Trained>
class TrainerOf : public Trainer {
 public:
  virtual Trained Network() const = 0;
};

// Training of a dense network on samples (the window's, or any other's).
//
// Loss: mean absolute error of the outputs, weighted by sample. AdamW with a one-cycle learning
// rate (up over the first 30 % of the steps, down to nothing by cosines), dropout between layers,
// noise on the scaled inputs. A round is an epoch; Network() has the weights of the epoch with the
// least validation loss; training ends early after `patience` epochs without a better one.

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
// Four stages (those that the layout has), one after the other: the lower autoencoder, its sampler,
// the upper autoencoder (on lower positions that the finished lower chain predicts), its sampler.
// Every step takes one frame of 64 rollouts: teacher-forced for the first 14 % of a stage's steps,
// then more and more (14 %) and for the rest (72 %) on what the network said itself, without
// gradients through earlier frames.
//   autoencoder: mean square error of the scaled frame + 0.005 KL to a standard normal, mean
//                over the latent variable
//   sampler:     squared difference of its Gaussian to the encoder's: published (Eq. 7)
//                |mu - mu_e|^2 + |sigma - sigma_e|^2, own of mean and log-variance, mean over the
//                latent variable; for the lower body also the foot-skate error of the output
//                (cvae_module_torch.h)
// Training `published`: Adam, autoencoders from 1e-4 down to 1e-7 in a straight line, samplers at
// 1e-4, and the sampler's output is decoded from a drawn z. `own` (default): AdamW with one cycle
// up to 1e-3, and z is the sampler's mean. Published is no weight of the foot skate: it is chosen
// here.
// Source: Yue et al., CVPR 2024; autoencoders as in Ling et al., Character controllers using motion
// VAEs, SIGGRAPH 2020. A round is a few hundred steps; after each the held-out sequences judge, and
// of every stage's last part the best round is kept.

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
  std::array<int, 4> steps = {12000, 8000, 12000, 8000};  // of the stages, where they are
  int rollout = 8, sampler_rollout = 16;                  // frames
  int batch = 64;
  int round = 400;              // steps between two judgements
  double learning_rate = 1e-3;  // the highest of the cycle (own)
  double kl_weight = 0.005;
  double skate_weight = 0.06;  // a cm a frame
};

inline constexpr const char* kCvaeStageNames[4] = {"lower autoencoder", "lower sampler",
                                                   "upper autoencoder", "upper sampler"};

class CvaeTrainer : public TrainerOf<CvaeWeights> {
 public:
  // scalings: the layout, and for the foot skate, which is in m; they become part of Network(). The
  // held-out loss is the mean error of the joint positions, m, of whole sequences predicted from
  // their first frame: of autoencoders with the encoder's z, of samplers with their own.
  static std::unique_ptr<CvaeTrainer> Make(const std::vector<CvaeSequence>& training,
                                           const std::vector<CvaeSequence>& held,
                                           const CvaeWeights& scalings, const CvaeOptions& options);

  // Weights of the four stages' networks: 865536, 136960, 1097904, 159232; 0 for absent stages.
  virtual std::array<int64_t, 4> NumParameters() const = 0;
};

}  // namespace pushid
