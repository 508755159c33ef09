// models: training of the diffusion network.
//
// A step takes some groups, each in the mirror or not, a little turned, larger or smaller, shows
// some of the first frames or none, adds noise of a random time t, and charges the estimate of x_0:
//
//   |x - x_0| + 2 |joint - joint_0| in m + 2 |the same differences of frames|, in means
//
// where observed frames weigh 0.1 and those after the recording's end nothing. Into some groups
// people are put who stand far from all others and do nothing: from groups alone the network cannot
// know that a push does not reach everybody. AdamW, a warm-up, the rate down to a fiftieth by a
// cosine, gradients clipped; what is used is the exponential mean of the weights.
#pragma once

#include <string>
#include <vector>

#include "models/generators/diffusion_network.h"
#include "models/restoration/trainer.h"

namespace pushid {

using ObservedGroup = std::vector<ObservedMotion>;  // all frames of everybody

struct DiffusionTrainingOptions : TrainerOptions {
  DiffusionStructure structure;
  int steps = 1500;
  int groups = 8;         // of a step
  int people_alone = 24;  // of every fifth step, where there are recordings of one person
  int warm_up = 100;      // steps
  double learning_rate = 2e-3;
  double weight_decay = 0.01;
  double clip = 1.0;         // largest norm of the gradient
  double averaging = 0.998;  // of the weights, from step to step
  double dropout = 0.1;      // of the statics
  double bystanders = 0.3;   // share of groups that get one or two
  double turn = 0.12;        // rad, largest
  double size = 0.05;        // share, largest
  double dt = 1.0 / 60.0;    // s
};

inline constexpr int kDiffusionRound = 50;  // steps of a point of the curve

class DiffusionTrainer : public Trainer {
 public:
  DiffusionTrainer(const std::vector<ObservedGroup>& learnt, const std::vector<ObservedGroup>& held,
                   const DiffusionTrainingOptions& options);

  // Mean losses of some steps; of the held groups, always in the same noise, at the end.
  DiffusionNetwork Network() const;  // of the mean weights
  // What LibTorch estimates from this noisy motion; for comparison with GroupDenoiser.
  Eigen::MatrixXf Estimate(const GroupFeatures& features, const Eigen::MatrixXf& noisy, double t);

 private:
  struct Torch;
};

}  // namespace pushid
