// models: training of LDP's chain.
//
// Four stages (those that the layout has), one after the other: the lower autoencoder, its sampler,
// the upper autoencoder (on lower positions that the finished lower chain predicts), its sampler.
// Every step takes one frame of 64 rollouts: teacher-forced for the first 14 % of a stage's steps,
// then more and more (14 %) and for the rest (72 %) on what the network said itself, without
// gradients through earlier frames.
//   autoencoder: mean square error of the scaled frame + 0.005 KL to a standard normal, mean
//                over the latent variable
//   sampler:     squared difference of its mean and log-variance to the encoder's; for the lower
//                body also how fast ankles slide which should stand (foot skate)
// Source: Yue et al., CVPR 2024; autoencoders as in Ling et al., Character controllers using motion
// VAEs, SIGGRAPH 2020. A round is a few hundred steps; after each the held-out sequences judge, and
// of every stage's last part the best round is kept.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "models/restoration/cvae_restoration.h"
#include "models/restoration/trainer.h"

namespace pushid {

// One person's motion; columns are frames, scaled.
struct CvaeSequence {
  Eigen::MatrixXf lower, upper, pendulum;
};

struct CvaeOptions : TrainerOptions {
  std::array<int, 4> steps = {12000, 8000, 12000, 8000};  // of the stages, where they are
  int rollout = 8, sampler_rollout = 16;                  // frames
  int batch = 64;
  int round = 400;  // steps between two judgements
  double learning_rate = 1e-3;
  double kl_weight = 0.005;
  double skate_weight = 0.1;
};

class CvaeTrainer : public Trainer {
 public:
  // scalings: the layout, and for the foot skate, which is in m; they become part of Best().
  CvaeTrainer(std::vector<CvaeSequence> training, std::vector<CvaeSequence> held,
              const CvaeWeights& scalings, const CvaeOptions& options);

  // The held-out loss is the mean error of the joint positions, m, of whole sequences predicted
  // from their first frame: of autoencoders with the encoder's z, of samplers with their own.
  CvaeWeights Best() const;

  // Of the four stages' networks: 865536, 136960, 1097904, 159232; 0 of stages that are not.
  std::array<int64_t, 4> NumParameters() const;

 private:
  struct Torch;
};

}  // namespace pushid
