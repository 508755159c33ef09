// models: training of LDP's chain.
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
//                (below)
// Training `published`: Adam, autoencoders from 1e-4 down to 1e-7 in a straight line, samplers at
// 1e-4, and the sampler's output is decoded from a drawn z. `own` (default): AdamW with one cycle
// up to 1e-3, and z is the sampler's mean. Published is no weight of the foot skate: it is chosen
// here.
// Source: Yue et al., CVPR 2024; autoencoders as in Ling et al., Character controllers using motion
// VAEs, SIGGRAPH 2020. A round is a few hundred steps; after each the held-out sequences judge, and
// of every stage's last part the best round is kept.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "models/restoration/cvae_restoration.h"
#include "models/restoration/trainer.h"

namespace pushid {

// One person's motion; columns are frames, scaled.
struct CvaeSequence {
  Eigen::MatrixXf lower, upper, pendulum;
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

class CvaeTrainer : public Trainer {
 public:
  // scalings: the layout, and for the foot skate, which is in m; they become part of Best().
  CvaeTrainer(std::vector<CvaeSequence> training, std::vector<CvaeSequence> held,
              const CvaeWeights& scalings, const CvaeOptions& options);

  // The held-out loss is the mean error of the joint positions, m, of whole sequences predicted
  // from their first frame: of autoencoders with the encoder's z, of samplers with their own.
  CvaeWeights Best() const;

  // Weights of the four stages' networks: 865536, 136960, 1097904, 159232; 0 for absent stages.
  std::array<int64_t, 4> NumParameters() const;

 private:
  struct Torch;
};

// What is minimized, without LibTorch in front, so that it can be tested by hand. Frames scaled, a
// column per sample.

struct CvaeGaussian {
  Eigen::MatrixXd mean, log_variance;
};
double CvaeAutoencoderLoss(const CvaeOptions& options, const CvaeGaussian& encoded,
                           const Eigen::MatrixXd& output, const Eigen::MatrixXd& frame);
// Without the foot skate.
double CvaeSamplerLoss(CvaeTraining training, const CvaeGaussian& sampled,
                       const CvaeGaussian& encoded);
// done: share of the stage's steps.
double CvaeLearningRate(const CvaeOptions& options, bool sampler, double done);

// The foot-skate error (FSE) that the lower sampler is trained against.
//
//   FSE = mean over ankles with h < H of  100 |way| (2 - 2^(max(0, h) / H)),  cm a frame
//
// way: of the ankle, horizontal, from the frame that the network started from to its output, m;
// h: the output's ankle above its own height at frame 0 of the person; H = 0.025 m. The same as
// FootSkate of ident/bodies/body_evaluation.cc. h counts in the weight and its gradient; which
// ankles count has no gradient. 0 where no ankle is low.
//
// In `ldp` coordinates positions contain the hip's way. In `tip` coordinates they do not: the hip
// is put at the end of the rod, so the way and the rise of that end are added (PendulumFrames).

// Not scaled, as FramesOf and PendulumFrames give them; a column per sample.
struct CvaeSkateFrames {
  Eigen::MatrixXd output, before, first;     // of the lower body: output, started from, frame 0
  Eigen::MatrixXd pendulum, first_pendulum;  // of the output's frame and of frame 0
};

// by_output: the gradient, of the shape of `output`.
double CvaeFootSkate(const CvaeLayout& layout, const CvaeSkateFrames& frames,
                     Eigen::MatrixXd* by_output);

}  // namespace pushid
